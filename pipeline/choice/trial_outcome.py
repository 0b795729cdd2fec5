"""How a candidate fared in a trial."""

from typing import NamedTuple

__all__ = ["TrialOutcome"]


class TrialOutcome(NamedTuple):
    """How a candidate fared.

    Attributes:
        held: whether the hand held the object.
        margin: share of the limits of slip and turn that was left, in [-1, 1]; at most 0 where not held.
        outcome: in words.
    """

    held: bool
    margin: float
    outcome: str
