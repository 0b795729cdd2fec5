"""The test of one grasp or of many; `lift` and `on_stand` say what is simulated."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from ..objects import LiftTest
from .grasp import Grasp
from .hold_result import HoldResult
from .lift import Lift
from .on_stand import OnStand
from .settings import HoldSettings

__all__ = ["hold_test", "hold_tests"]


def hold_test(grasp: Grasp, settings: HoldSettings | None = None) -> HoldResult:
    """Puts a grasp to the test of its task: whether the hand holds, turns or presses as it should.

    The same input gives the same bits.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
    """
    settings = settings or grasp.squeeze.settings
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return OnStand(grasp, settings).run()
    lift = Lift(grasp, settings)
    lift.squeeze()
    return lift.result([lift.hold(direction) for direction in settings.directions])


def hold_tests(
    grasps: Sequence[Grasp], settings: HoldSettings | None = None, *, workers: int = 1
) -> list[HoldResult]:
    """Tests many grasps over `workers` threads (MuJoCo lets go of Python's lock while it steps).

    The results are those of `hold_test`, bit by bit, at any number of workers.
    """
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(lambda grasp: hold_test(grasp, settings), grasps))
