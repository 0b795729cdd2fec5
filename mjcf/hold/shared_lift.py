"""A lift that several tests of one grasp share, for they begin alike."""

from ...objects import LiftTest
from ..model import Grasp
from ..settings import HoldSettings
from .checks import trial_settings
from .lift import Lift

__all__ = ["shared_lift"]


def shared_lift(grasp: Grasp, *, settings: HoldSettings | None = None) -> Lift | None:
    """A lift to hand to tests of this grasp with these settings; None where the task is no lift.

    The fingers then close once, and the usual squeeze is made once. What tests find is the same to the bit.

    Args:
        grasp: the grasp.
        settings: of the tests; None takes what the squeeze was planned for.
    """
    settings = trial_settings(grasp, settings)
    return Lift(grasp, settings) if isinstance(grasp.configuration.task.test, LiftTest) else None
