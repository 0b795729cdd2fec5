"""What a try is worth."""

from dataclasses import dataclass
from typing import Literal, get_args

from ...arguments import check_number
from ...errors import UnknownName

__all__ = ["Reward", "RewardKind"]

RewardKind = Literal["held", "margin"]


@dataclass(frozen=True)
class Reward:
    """What a try is worth.

    Attributes:
        kind: `held`, 1 where the object is held, else 0; or `margin`, in [-1, 1].
        cost: of each try, which is taken off.
    """

    kind: RewardKind = "held"
    cost: float = 0.0

    def __post_init__(self) -> None:
        if self.kind not in get_args(RewardKind):
            raise UnknownName("reward", "", "reward", str(self.kind), get_args(RewardKind))
        check_number("cost", self.cost, least=0.0)

    def of(self, held: bool, margin: float) -> float:
        """The worth of a try."""
        return (float(held) if self.kind == "held" else margin) - self.cost

    @property
    def of_nothing(self) -> float:
        """The worth of an action that is no candidate, or one that was tried before."""
        return (0.0 if self.kind == "held" else -1.0) - self.cost
