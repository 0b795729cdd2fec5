"""How a test in one direction ended."""

from enum import Enum

__all__ = ["Outcome"]


class Outcome(Enum):
    """How a test in one direction ended; the first reason that applies."""

    HELD = "held"
    SLIPPED = "slipped too far"
    ROTATED = "turned too far"
    LET_GO = "a contact of the task was lost"
    SHORT = "did not get as far as asked"
    WEAK = "did not press as hard as asked"
    OVERLOADED = "a servo was at its limit"
    UNSTABLE = "the simulation broke down"
