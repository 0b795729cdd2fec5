"""A grasp: a configuration with the squeeze that should hold it, and the way there."""

from dataclasses import dataclass
from functools import cached_property

from ...retraction import Approach, find_approach
from ...solver import Configuration
from .squeeze import Squeeze

__all__ = ["Grasp"]


@dataclass(frozen=True, eq=False)
class Grasp:
    """A configuration and how to squeeze in it.

    Attributes:
        configuration: where hand and object are when the contacts just touch.
        squeeze: targets of the servos.
        known_approach: the configuration's approach where it has been found before; None looks for it when it
            is needed.
    """

    configuration: Configuration
    squeeze: Squeeze
    known_approach: Approach | None = None

    @cached_property
    def approach(self) -> Approach:
        """The way on which the fingers close: every test begins at its pregrasp.

        Where the grasp is not reachable this is as far as the fingers open without touching anything else.
        """
        return self.known_approach or find_approach(self.configuration)
