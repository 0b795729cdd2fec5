"""The test of one grasp; `lift` and `stand_trial` say what is simulated."""

from collections.abc import Sequence

from ...arguments import check_number
from ...base.numeric.arrays import Array
from ...objects import LiftTest
from ..model import Grasp
from ..settings import Direction, HoldSettings
from .checks import trial_settings
from .lift import Lift, started_lift
from .placement import Placement
from .result import DirectionResult, HoldResult
from .stand_trial import StandTrial

__all__ = ["closed_hand", "held_directions", "hold_test", "hold_test_if_passed", "passes"]


def hold_test(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    load: float = 1.0,
    until_failed: bool = False,
    lift: Lift | None = None,
) -> HoldResult:
    """Puts a grasp to the test of its task: whether the hand holds, turns or presses as it should.

    The same input gives the same bits.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
        load: how many times the task's load: gravity in a lift, the friction of the hinge in a turn, the
            force that is asked for in a press. The squeeze stays as planned.
        until_failed: whether a lift ends where it fails first: the verdict is the same, but the directions
            that come after are left out, all of them where the squeeze itself has failed.
        lift: of this grasp with these settings, to go on with; None begins one.

    Raises:
        InputError: an argument of another type, or a load that is negative or no number.
    """
    settings = trial_settings(grasp, settings)
    check_number("load", load, least=0.0)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return StandTrial(grasp, settings, load=load).run()
    lift = started_lift(grasp, settings, lift)
    return lift.result(held_directions(lift, settings, load, until_failed))


def hold_test_if_passed(
    grasp: Grasp, *, settings: HoldSettings | None = None, firmly: bool = False, lift: Lift | None = None
) -> HoldResult | None:
    """The `hold_test` of a grasp that passes it; None for any other: it ends as soon as that is known.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
        firmly: whether the squeeze must hardly move the object, too, as one chosen among others has to;
            see `Lift.squeezes_firmly`.
        lift: of this grasp with these settings, to go on with; None begins one.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        result = StandTrial(grasp, settings).run()
        return result if result.held and (result.is_firm or not firmly) else None
    lift = lift or Lift(grasp, settings)
    if firmly and not lift.squeezes_firmly(settings.firm_share):
        return None
    lift.squeeze()
    if not lift.keeps_place():
        return None
    found: list[DirectionResult] = []
    for direction in settings.directions:
        found.append(lift.hold(direction, while_held=True))
        if not found[-1].held:
            return None
    return lift.result(found)


def passes(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    placement: Placement | None = None,
    directions: Sequence[Direction] | None = None,
    closed: Array | None = None,
) -> bool:
    """The verdict of `hold_test` alone: a lift ends where it fails first.

    Args:
        grasp: the grasp.
        settings: what to assume; None takes what the squeeze was planned for.
        placement: where the object is; None for where the grasp has it.
        directions: of gravity in a lift that are tried, in this order; None for all of the settings'.
        closed: see `closed_hand`; None closes the hand with these settings.
    """
    settings = trial_settings(grasp, settings)
    if not isinstance(grasp.configuration.task.test, LiftTest):
        return StandTrial(grasp, settings, placement, closed=closed).holds()
    lift = Lift(grasp, settings, placement, closed=closed)
    lift.squeeze(for_verdict=True)
    tried = settings.directions if directions is None else directions
    return lift.keeps_place() and all(lift.holds(direction) for direction in tried)


def closed_hand(grasp: Grasp, settings: HoldSettings, lift: Lift | None = None) -> Array:
    """The state of all in which the hand is closed on the object, for `passes` with other numerical settings.

    Args:
        grasp: the grasp.
        settings: with which it is closed.
        lift: of this grasp with these settings that may have closed it; None closes it.
    """
    if lift is None and not isinstance(grasp.configuration.task.test, LiftTest):
        return StandTrial(grasp, settings).closed
    return (lift or Lift(grasp, settings)).squeezing.closed


def held_directions(
    lift: Lift, settings: HoldSettings, load: float, until_failed: bool
) -> list[DirectionResult]:
    """What becomes of a squeezed grasp in each direction."""
    found: list[DirectionResult] = []
    if until_failed and not lift.result([]).held:
        return found
    for direction in settings.directions:
        found.append(lift.hold(direction, load))
        if until_failed and not found[-1].held:
            break
    return found
