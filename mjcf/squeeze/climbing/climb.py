"""Climbing on the contact manifold to where a measure of the grasp is larger.

A measure is the value of a linear program (`grasp_strength`, `grasp_slack`): smooth but for kinks, on which
ascents along one slope come to rest far from the top. So each step maximises the least of several slopes,
within a trust region, along the linearised contacts and inside joint limits, patches and caps, by a quadratic
program: of the slope here and of those at other places on the way, also at those that turned out lower (a
bundle method; Kiwiel, *Methods of descent for nondifferentiable optimization*, 1985). Where a grasp is clear
of penetration and is to stay so, each pair of bodies that are near each other adds a row.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ....base.machine.cancellation import give_up_if_asked
from ....base.numeric.arrays import Array, Mask
from ....base.numeric.quadratic_program import solve_quadratic_program
from ....retraction import ClearRoom
from ....solver import ContactManifold, State
from .grasp_measure import GraspMeasure, Strength

__all__ = ["climb"]

_MOST_STEPS = 40
# A climb ends where so many steps gain less than this share of the value, or where over a long step slopes
# promise less than a step's part of it.
_STALL_STEPS, _STALL, _STALL_BELOW = 5, 0.02, 0.005
_FIRST_STEP = 0.2  # rad of joints and pose, share of a patch; positions count per `_LENGTH_M`
_LARGEST_STEP = 0.3
_SMALLEST_STEP = 2e-3
_LENGTH_M = 0.05
# A step must gain so much, and this share of what slopes promise.
_LEAST_GAIN, _PROMISED = 1e-6, 0.1
# Places that are tried from one place at most, and after how many that were lower the step is halved.
_MOST_TRIES, _TRIES_A_LENGTH = 8, 2
# Slopes of earlier places that still count.
_MOST_SLOPES = 8
# How many lengths of a step it is worth to go as far as one slope rises: the less, the less it is turned into
# corners of the trust region.
_HASTE = 10.0
# Makes the quadratic program strictly convex in the promised gain, too.
_EASE = 1e-6
# Cap normals are kept this far (in cosine) inside their caps, as the linearisation is not exact.
_CAP_MARGIN = 1e-4
# Bodies within this distance of each other are watched in a step; it is too long if others come together.
_NEAR_M = 0.02
# Joints and patch parameters end up this far inside their limits, where the existence test has room.
_LIMIT_MARGIN = 1e-4
_FAR = 1e6


@dataclass(frozen=True, eq=False)
class _Slope:
    """How the value is thought to change along dx: by at most `offset` + `gradient` . dx."""

    gradient: Array
    offset: float = 0.0

    def seen_from(self, dx: Array, gain: float) -> "_Slope":
        """The same from a place that lies `dx` on and `gain` higher.

        No less than nothing: the value there is known, and slopes of a function that is not concave may lie
        below it.
        """
        return replace(self, offset=max(self.offset + float(self.gradient @ dx) - gain, 0.0))


def climb(
    manifold: ContactManifold,
    measure: GraspMeasure,
    state: State,
    is_enough: Callable[[Strength], bool],
    room: ClearRoom | None,
) -> list[State]:
    """The states on the way up, without the first one, to where it is enough or steps hardly help."""
    here, step = measure.at(state), _FIRST_STEP
    way: list[State] = []
    slopes: list[_Slope] = []
    values = [here.value]
    while len(way) < _MOST_STEPS and not is_enough(here):
        give_up_if_asked()
        least = _least_rise(here.value) / _STALL_STEPS
        there, step = _step(manifold, measure, here, step, room, slopes, least)
        if there is None:
            break
        step = min(1.5 * step, _LARGEST_STEP)
        here = there
        way.append(here.state)
        values.append(here.value)
        if len(values) > _STALL_STEPS and here.value - values[-1 - _STALL_STEPS] < _least_rise(here.value):
            break
    return way


def _least_rise(value: float) -> float:
    """What `_STALL_STEPS` steps must gain at least."""
    return (_STALL if value > 0.0 else _STALL_BELOW) * abs(value)


def _step(
    manifold: ContactManifold,
    measure: GraspMeasure,
    here: Strength,
    step: float,
    room: ClearRoom | None,
    slopes: list[_Slope],
    least: float,
) -> tuple[Strength | None, float]:
    """A better state one step on, or None, and the length of the step.

    `slopes` are those of other places, as seen from here; those that are found are added, and where a step is
    made, all are seen from there. Where they promise less than `least` over a long step, there is none.
    """
    apart = None if room is None else room.rows(here.state, _NEAR_M)
    slopes.insert(0, _Slope(measure.gradient(here)))
    lower = 0
    for _ in range(_MOST_TRIES):
        if step <= _SMALLEST_STEP:
            break
        dx = _uphill(manifold, here.state, slopes, step, apart)
        if dx is not None and step >= _FIRST_STEP and _promised(slopes, dx) < least:
            break
        state = None if dx is None else _back_on_manifold(manifold, manifold.retract(here.state, dx))
        if dx is None or state is None or (room is not None and not room.is_clear(state)):
            step *= 0.5
            continue
        there = measure.at(state)
        gain = there.value - here.value
        if gain > max(_LEAST_GAIN, _PROMISED * _promised(slopes, dx)):
            kept = slopes[:_MOST_SLOPES] if there.is_like(here) else []
            slopes[:] = [slope.seen_from(dx, gain) for slope in kept]
            return there, step
        lower += 1
        if not there.is_like(here) or lower % _TRIES_A_LENGTH == 0:
            step *= 0.5
        if there.is_like(here):
            slopes.insert(1, _Slope(measure.gradient(there)).seen_from(-dx, -gain))
    return None, step


def _promised(slopes: list[_Slope], dx: Array) -> float:
    """What the slopes let a step gain."""
    return min(slope.offset + float(slope.gradient @ dx) for slope in slopes)


def _uphill(
    manifold: ContactManifold,
    state: State,
    slopes: list[_Slope],
    step: float,
    apart: tuple[Array, Array] | None,
) -> Array | None:
    """The step (n_tangent,) along which the least of the slopes rises most, and short; None for none."""
    scale, rows, lower, upper, equal = _limits(manifold, state, step, apart, into_caps=False)
    n, k = len(scale), len(slopes)
    gradients = np.array([slope.gradient for slope in slopes]) * scale
    size = max(float(np.abs(gradients[0]).max(initial=0.0)), 1e-12)
    # One more unknown, the gain in units of the steepest rise here, is at most what each slope has.
    A = np.zeros((len(rows) + k, n + 1))
    A[: len(rows), :n] = rows
    A[len(rows) :, :n] = -gradients / size
    A[len(rows) :, n] = 1.0
    H = np.eye(n + 1) / (_HASTE * step)
    H[n, n] = _EASE
    offsets = np.array([slope.offset for slope in slopes]) / size
    is_equal = np.zeros(n + 1 + len(A), dtype=bool)
    is_equal[n + 1 : n + 1 + len(rows)] = equal[n:]
    y = solve_quadratic_program(
        H,
        np.append(np.zeros(n), -1.0),
        A,
        np.concatenate([np.insert(lower, n, -_FAR), np.full(k, -_FAR)]),
        np.concatenate([np.insert(upper, n, _FAR), offsets]),
        is_equal,
    )
    return None if y is None else y[:n] * scale


def _back_on_manifold(manifold: ContactManifold, state: State) -> State | None:
    """The state projected on the contacts, and pushed into its caps where it has left them."""
    for _ in range(6):
        projected = manifold.project(state)
        if projected is None or manifold.is_feasible(projected):
            return projected
        scale, rows, lower, upper, equal = _limits(manifold, projected, 0.5, None, into_caps=True)
        n = len(scale)
        y = solve_quadratic_program(np.eye(n), np.zeros(n), rows, lower, upper, equal)
        if y is None:
            return None
        state = manifold.retract(projected, y * scale)
    return None


def _limits(
    manifold: ContactManifold,
    state: State,
    step: float,
    apart: tuple[Array, Array] | None,
    *,
    into_caps: bool,
) -> tuple[Array, Array, Array, Array, Mask]:
    """What steps y keep to, in units `scale`: contacts, limits and caps, to first order.

    A state outside its caps must not leave them farther, and must come back with `into_caps`. Of `apart`, see
    `ClearRoom.rows`, bodies keep their distance.

    Returns:
        Units (n_tangent,), rows (m, n_tangent), lower and upper bounds (n_tangent + m,) of y and of the rows,
        and which of them are equal.
    """
    c, J = manifold.linearise(state)
    cap, J_cap = manifold.inequalities(state)
    n = manifold.n_tangent
    scale = np.ones(n)
    scale[manifold.n_q : manifold.n_q + 3] = _LENGTH_M
    low, high = -step * scale, step * scale
    x = np.concatenate([state.q, state.params])
    low[manifold.bounded] = np.maximum(
        low[manifold.bounded], np.minimum(manifold.lower + _LIMIT_MARGIN - x, 0.0)
    )
    high[manifold.bounded] = np.minimum(
        high[manifold.bounded], np.maximum(manifold.upper - _LIMIT_MARGIN - x, 0.0)
    )
    cap_low = _CAP_MARGIN - cap if into_caps else np.minimum(_CAP_MARGIN - cap, 0.0)
    J_apart, least_m = (np.zeros((0, n)), np.zeros(0)) if apart is None else apart
    # In units of the length by which positions count, as the other rows are.
    rows = np.vstack([J * scale, J_cap * scale, J_apart * scale / _LENGTH_M])
    upper = np.concatenate([high / scale, -c, np.full(len(cap) + len(least_m), _FAR)])
    lower = np.concatenate([low / scale, -c, cap_low, least_m / _LENGTH_M])
    equal = np.zeros(len(upper), dtype=bool)
    equal[n : n + len(c)] = True
    return scale, rows, lower, upper, equal
