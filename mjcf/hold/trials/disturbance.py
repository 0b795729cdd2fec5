"""An object that is not as the squeeze was planned for: heavier, more slippery, unbalanced, elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ....arguments import check_number
from ....objects import LiftTest
from ...model import Burden, Grasp
from ...settings import HoldSettings
from ..checks import trial_settings
from ..hold import held_directions
from ..lift import Lift
from ..placement import Placement
from ..result import HoldResult
from ..stand_trial import StandTrial

__all__ = ["Disturbance", "hold_disturbed"]


@dataclass(frozen=True, eq=False)
class Disturbance:
    """How the object differs from what was planned with.

    Attributes:
        burden: what its mass and its centre of mass are.
        friction_factor: times its friction.
        placement: where it is when the hand closes; None for where the grasp has it.
    """

    burden: Burden = field(default_factory=Burden)
    friction_factor: float = 1.0
    placement: Placement | None = None

    def __post_init__(self) -> None:
        check_number("Disturbance.friction_factor", self.friction_factor, above=0.0)


def hold_disturbed(
    grasp: Grasp,
    disturbance: Disturbance,
    *,
    settings: HoldSettings | None = None,
    loads: Sequence[float] = (1.0,),
    until_failed: bool = False,
) -> tuple[HoldResult, ...]:
    """Puts a grasp to its task's test with another object than planned; one result for each load.

    The hand squeezes once for all loads of a lift. In a turn or a press a stand carries the object, so that
    mass and centre of mass have no say there.

    Args:
        grasp: the grasp; its squeeze stays as planned.
        disturbance: what is different.
        settings: what to assume otherwise; None takes what the squeeze was planned for.
        loads: how many times the task's load, ascending; see `hold_test`.
        until_failed: whether a lift ends where it fails first, and with it what the larger loads would do:
            their result is then that of the load that failed.

    Raises:
        InputError: an argument of another type, or a load that is no number or negative.
    """
    settings = trial_settings(grasp, settings)
    for load in loads:
        check_number("load", load, least=0.0)
    friction = disturbance.friction_factor * settings.sliding_friction(grasp.configuration.task.object)
    settings = replace(settings, friction=friction)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return tuple(StandTrial(grasp, settings, disturbance.placement, load=load).run() for load in loads)
    lift = Lift(grasp, settings, disturbance.placement, disturbance.burden)
    lift.squeeze()
    results: list[HoldResult] = []
    for load in loads:
        if until_failed and results and not results[-1].held:
            results.append(results[-1])
            continue
        results.append(lift.result(held_directions(lift, settings, load, until_failed)))
    return tuple(results)
