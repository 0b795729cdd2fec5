"""The test of one grasp; `lift` and `stand_trial` say what is simulated."""

from ...arguments import check_number
from ...objects import LiftTest
from ..model import Grasp
from ..settings import HoldSettings
from .checks import trial_settings
from .lift import Lift
from .placement import Placement
from .result import HoldResult
from .stand_trial import StandTrial

__all__ = ["hold_test", "passes"]


def hold_test(grasp: Grasp, *, settings: HoldSettings | None = None, load: float = 1.0) -> HoldResult:
    """Puts a grasp to the test of its task: whether the hand holds, turns or presses as it should.

    The same input gives the same bits.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
        load: how many times the task's load: gravity in a lift, the friction of the hinge in a turn, the
            force that is asked for in a press. The squeeze stays as planned.

    Raises:
        InputError: an argument of another type, or a load that is negative or no number.
    """
    settings = trial_settings(grasp, settings)
    check_number("load", load, least=0.0)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return StandTrial(grasp, settings, load=load).run()
    lift = Lift(grasp, settings)
    lift.squeeze()
    return lift.result([lift.hold(direction, load) for direction in settings.directions])


def passes(grasp: Grasp, *, settings: HoldSettings | None = None, placement: Placement | None = None) -> bool:
    """The verdict of `hold_test` alone: a lift ends where it fails first.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
        placement: where the object is; None for where the grasp has it.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return StandTrial(grasp, settings, placement).run().held
    lift = Lift(grasp, settings, placement)
    lift.squeeze()
    return lift.result([]).held and all(lift.hold(direction).held for direction in settings.directions)
