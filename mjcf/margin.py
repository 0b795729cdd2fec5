"""The margin of a grasp: the multiple of gravity at which it first fails.

A grasp that fails under some load may hold again under a larger one, because the object has slid into another
place. So the search never looks at a load before all smaller rungs of a ladder have held: 1/2, 1, 2, 4, ...
times gravity, up to a cap. Between the last rung that held and the first that did not it bisects. What comes
out was tested and held, and so was every rung below it; a load within `margin_resolution` above it was tested
and failed. A later direction is only tried up to the margin that the earlier ones leave.
"""

from collections.abc import Callable, Iterable
from functools import cache

from .grasp import Grasp
from .lift import Lift
from .settings import Direction, HoldSettings

__all__ = ["first_failure", "hold_margin"]

_LOWEST_RUNG = 0.5


def hold_margin(grasp: Grasp, settings: HoldSettings | None = None) -> float:
    """The margin over all directions, in [0, margin_cap]; the squeeze stays the one that was planned.

    It is at least 1 exactly where the hold test with these settings is passed, and 0 where the squeeze itself
    moves the object too far or not even the lowest rung is held.

    Args:
        grasp: a grasp for a lift.
        settings: of the test; None takes what the squeeze was planned for.
    """
    settings = settings or grasp.squeeze.settings
    lift = Lift(grasp, settings)
    lift.squeeze()
    squeezed = lift.result([])
    if not (squeezed.fits and squeezed.kept_place):
        return 0.0
    margin = settings.margin_cap
    for direction in settings.directions:
        margin = _in_direction(lift, direction, margin, settings.margin_resolution)
    return margin


def _in_direction(lift: Lift, direction: Direction, most: float, resolution: float) -> float:
    return first_failure(lambda load: lift.hold(direction, load).held, most, resolution)


def first_failure(holds: Callable[[float], bool], most: float, resolution: float) -> float:
    """The largest load up to `most` that was found to be held, before the first one that was not.

    Args:
        holds: whether a load is held; asked once for each load.
        most: loads above this are not tried.
        resolution: how far, as a share of it, the load that failed may lie above the answer.
    """
    if most <= 0.0:
        return 0.0
    known = cache(holds)
    low = 0.0
    for rung in _ladder(most):
        if not known(rung):
            return _bisect(known, low, rung, resolution)
        low = rung
    return low


def _ladder(most: float) -> Iterable[float]:
    rung = _LOWEST_RUNG
    while rung < most:
        yield rung
        rung *= 2.0
    yield most


def _bisect(holds: Callable[[float], bool], low: float, high: float, resolution: float) -> float:
    least = resolution * min(high, _LOWEST_RUNG)  # below the lowest rung, the way to 0 is not endless
    while high - low > max(resolution * high, least):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low
