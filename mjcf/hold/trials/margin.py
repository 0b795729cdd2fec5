"""The margin of a grasp: the multiple of the load at which it first fails, its squeeze as it was planned.

The load is gravity in a lift, the friction of the hinge in a turn, the force that is asked for in a press.

A grasp that fails under some load may pass again under a larger one, because the object has slid into another
place. So the search climbs a ladder from the load itself, 1, 2, 4, ... times, up to a cap, and never looks
beyond a rung that failed. Between the last rung that passed and the first that did not it bisects; where the
load itself is too much, below it. What comes out was tested and passed, in the direction that was tried first
at every rung from 1 up to it, in others at it and at 1; a load within `margin_resolution` above it was tested
and failed.

A press needs no search: what is asked for changes nothing in the simulation, so the margin is the force that
was reached over the one asked for.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from math import inf

from ....objects import LiftTest, PressTest
from ...model import Grasp
from ...settings import Direction, HoldSettings
from ..checks import trial_settings
from ..lift import Lift, started_lift
from ..outcome import Outcome
from ..stand_trial import StandTrial
from ..strain import most_strained_first, strain

__all__ = ["Margin", "find_margin", "first_failure", "hold_margin"]

_LOWEST_RUNG = 0.5


@dataclass(frozen=True)
class Margin:
    """The load at which a grasp first fails, and where.

    Attributes:
        value: what it still passes, as a multiple of the load; see `hold_margin`.
        weakest: the directions of gravity of a lift by the loads at which they gave way, the least first;
            those in which nothing gave way follow by how much of their limits the load itself takes.
    """

    value: float
    weakest: tuple[Direction, ...] = ()


def hold_margin(
    grasp: Grasp, *, settings: HoldSettings | None = None, strains: Sequence[float] | None = None
) -> float:
    """The margin of the test of the grasp's task, in [0, margin_cap]; of a lift over all directions.

    It is at least 1 exactly where the test with these settings is passed, and 0 where no load at all is: the
    squeeze itself moves the object too far, or a contact slips or leaves however little is asked.

    Args:
        grasp: the grasp.
        settings: of the test; None takes what the squeeze was planned for.
        strains: of a lift that is known to be held with these settings, the `strain` of each direction at the
            load itself, which is not tried again then; None where nothing is known.
    """
    return find_margin(grasp, settings=settings, strains=strains).value


def find_margin(
    grasp: Grasp,
    *,
    settings: HoldSettings | None = None,
    strains: Sequence[float] | None = None,
    lift: Lift | None = None,
    held: bool = False,
    pressed_N: float | None = None,
) -> Margin:
    """`hold_margin`, and where a lift gives way first.

    Args:
        grasp: the grasp.
        settings: see `hold_margin`.
        strains: see `hold_margin`.
        lift: of this grasp with these settings, to go on with; None begins one.
        held: whether a turn or a press is known to pass its test with these settings.
        pressed_N: the least force that was reached in a press that is `held`; None makes it again.
    """
    settings = trial_settings(grasp, settings)
    match grasp.configuration.task.test:
        case LiftTest():
            return _of_lift(started_lift(grasp, settings, lift), settings, strains)
        case PressTest() as test:
            return Margin(_of_press(grasp, settings, test, pressed_N if held else None))
        case _:
            trial = StandTrial(grasp, settings)
            return Margin(
                first_failure(
                    lambda load: (held and load == 1.0) or trial.holds(load),
                    settings.margin_cap,
                    settings.margin_resolution,
                )
            )


def _of_lift(lift: Lift, settings: HoldSettings, strains: Sequence[float] | None) -> Margin:
    held = set(settings.directions)
    if strains is None:
        if not lift.keeps_place():
            return Margin(0.0)
        at_load = [lift.hold(direction) for direction in settings.directions]
        held = {result.gravity for result in at_load if result.held}
        strains = [
            strain(result.slip_m, result.rotation_rad, settings) if result.held else inf for result in at_load
        ]
    margin = settings.margin_cap
    # Most likely that one decides which comes closest to its limits; the others are only tried up to the
    # margin that it leaves.
    order = most_strained_first(settings, strains)
    failed = dict.fromkeys(order, inf)
    for direction in order:
        found = _InDirection(lift, direction, direction in held)
        margin = found.margin(margin, settings.margin_resolution, is_first=direction == order[0])
        failed[direction] = found.failed
    return Margin(margin, tuple(sorted(order, key=lambda direction: failed[direction])))


class _InDirection:
    """Loads on a lift in one direction of gravity.

    Args:
        lift: squeezed.
        direction: of gravity.
        held: whether the load itself is.
    """

    def __init__(self, lift: Lift, direction: Direction, held: bool):
        self._lift, self._direction, self._held = lift, direction, held
        self._known: dict[float, bool] = {}

    @property
    def failed(self) -> float:
        """The least load that was tried and failed."""
        return min((load for load, held in self._known.items() if not held), default=inf)

    def margin(self, most: float, resolution: float, *, is_first: bool) -> float:
        """The margin up to `most`; where others leave no more than that, it is tried before all else."""
        if self._held and not is_first and self._holds(most):
            return most
        return first_failure(self._holds, most, resolution)

    def _holds(self, load: float) -> bool:
        if load not in self._known:
            self._known[load] = self._held if load == 1.0 else self._lift.holds(self._direction, load)
        return self._known[load]


def _of_press(grasp: Grasp, settings: HoldSettings, test: PressTest, pressed_N: float | None) -> float:
    if pressed_N is not None:
        return min(settings.margin_cap, pressed_N / test.force_N)
    result = StandTrial(grasp, settings).run()
    # Other outcomes come from slip, a lost contact or a servo at its limit: no smaller wish would mend them.
    pressed = result.directions[0].outcome in (Outcome.HELD, Outcome.WEAK)
    if not (pressed and result.fits and result.kept_place and result.pressed_N is not None):
        return 0.0
    return min(settings.margin_cap, result.pressed_N / test.force_N)


def first_failure(passes: Callable[[float], bool], most: float, resolution: float) -> float:
    """The largest load up to `most` that was found to pass, before the first one that did not.

    Args:
        passes: whether a load is passed; asked once for each load.
        most: loads above this are not tried.
        resolution: how far, as a share of it, the load that failed may lie above the answer.
    """
    if most <= 0.0:
        return 0.0
    known = cache(passes)
    low = 0.0
    for rung in _ladder(most):
        if not known(rung):
            break
        low = rung
    else:
        return most
    if low == 0.0 and rung > _LOWEST_RUNG:
        low, rung = (_LOWEST_RUNG, rung) if known(_LOWEST_RUNG) else (0.0, _LOWEST_RUNG)
    return _bisect(known, low, rung, resolution)


def _ladder(most: float) -> Iterable[float]:
    rung = 1.0
    while rung < most:
        yield rung
        rung *= 2.0
    yield most


def _bisect(passes: Callable[[float], bool], low: float, high: float, resolution: float) -> float:
    least = resolution * min(high, _LOWEST_RUNG)  # below the lowest rung, the way to 0 is not endless
    while high - low > max(resolution * high, least):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    return low
