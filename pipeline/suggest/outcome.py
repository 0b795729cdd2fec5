"""What came of a try, in as few words as a search needs to go on from it."""

from dataclasses import dataclass
from typing import Literal

__all__ = ["Outcome", "Step"]

Step = Literal["found", "askew", "unreached", "sinking", "weak"]


@dataclass(frozen=True)
class Outcome:
    """What came of a try.

    Attributes:
        step: that refused it, or `found`: its places are more askew than the hand's flat pads; the solver
            found no certified configuration; none could be freed of penetration; or none carries the load.
        blocking: of each configuration that could not be freed, the two bodies that kept it from that.
        askew_deg: of places that are too askew, by how much.
    """

    step: Step
    blocking: tuple[tuple[str, str], ...] = ()
    askew_deg: float | None = None
