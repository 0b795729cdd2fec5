"""A grasp: a configuration with the squeeze that should hold it, and the way there."""

from dataclasses import dataclass
from functools import cached_property

from ...arguments import check_instance
from ...retraction import Approach, contact_gaps, find_approach
from ...solver import Configuration
from ..settings import HoldSettings
from .checks import check_configuration
from .grasp import trial_mjcf
from .squeeze import Squeeze

__all__ = ["Grasp"]


@dataclass(frozen=True, eq=False, repr=False)
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

    def __post_init__(self) -> None:
        check_configuration(self.configuration)
        check_instance("squeeze", self.squeeze, Squeeze, "a Squeeze, as plan_squeeze plans it")

    def __str__(self) -> str:
        return f"grasp of {self.configuration.task.name}: {self.squeeze}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    @cached_property
    def approach(self) -> Approach:
        """The way on which the fingers close: every test begins at its pregrasp.

        Where the grasp is not reachable this is as far as the fingers open without touching anything else.
        """
        return self.known_approach or find_approach(self.configuration)

    @cached_property
    def gap_m(self) -> float:
        """The widest gap between the bodies of a contact, at least 0; see `contact_gaps`."""
        return max(0.0, *contact_gaps(self.configuration))

    def mjcf(self, settings: HoldSettings | None = None) -> str:
        """The grasp as `trial_mjcf` writes it, with keyframes for the squeeze and the open fingers.

        Args:
            settings: friction and solver settings; None takes those that the squeeze was planned for.
        """
        return trial_mjcf(
            self.configuration,
            settings=settings or self.squeeze.settings,
            targets=self.squeeze.targets,
            pregrasp=self.approach.pregrasp,
            pads=self.squeeze.pads,
        )
