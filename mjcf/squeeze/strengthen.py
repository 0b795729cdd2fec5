"""Sliding a grasp to where the hand can hold it.

The solver's configurations make the contacts, no more: the line between two fingertips may lie far outside
their friction cones, or the object's weight may turn it about that line. The contact manifold has more
dimensions than such a grasp needs, so this stage climbs on it, from where the solver stands, until a squeeze
carries the planned load.

Each step solves a quadratic program, ascent of what `grasp_strength` measures within a trust region along the
linearised contacts and inside joint limits, patches and caps, and then returns to the manifold. Where a grasp
is clear of penetration and is to stay so, each pair of bodies that are near each other adds a row.
"""

from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...cancellation import give_up_if_asked
from ...quadratic_program import solve_quadratic_program
from ...retraction import ClearRoom, RetractionSettings
from ...solver import Configuration, ContactManifold, State, certify_state
from ..model import check_configuration, checked_settings
from ..settings import HoldSettings
from .grasp_strength import Strength, StrengthMeasure

__all__ = ["strengthen"]

_MOST_STEPS = 40
# A climb ends where so many steps gain less than this share of the value.
_STALL_STEPS, _STALL = 5, 0.03
_FIRST_STEP = 0.2  # rad of joints and pose, share of a patch; positions count per `_LENGTH_M`
_LARGEST_STEP = 0.3
_SMALLEST_STEP = 2e-3
_LENGTH_M = 0.05
_LEAST_GAIN = 1e-6
# Cap normals are kept this far (in cosine) inside their caps, as the linearisation is not exact.
_CAP_MARGIN = 1e-4
# Bodies within this distance of each other are watched in a step; it is too long if others come together.
_NEAR_M = 0.02
# Joints and patch parameters end up this far inside their limits, where the existence test has room.
_LIMIT_MARGIN = 1e-4


def strengthen(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    keep_clear: RetractionSettings | None = None,
) -> Configuration:
    """The configuration, or one on the same contact manifold whose squeeze carries more.

    It stops at `settings.planned_load` times the weight with the friction that squeezes are best planned
    with, or where steps hardly help. The result is certified anew: where that fails, the last place on the
    way that can be certified is taken.

    Args:
        configuration: where to begin.
        settings: of the hold test to come.
        keep_clear: thresholds of clearance that are kept on the way, where the configuration is clear by
            them; None heeds contacts alone.
    """
    check_configuration(configuration)
    settings = checked_settings(settings)
    manifold = ContactManifold(configuration.task)
    friction = settings.planned_frictions(configuration.task.object)[0]
    room = None if keep_clear is None else ClearRoom(manifold, keep_clear)
    way = _climb(manifold, configuration.state, replace(settings, friction=friction), room)
    for state in reversed(way):
        reached = certify_state(manifold, state)
        if reached.certified or not configuration.certified:
            return reached
    return configuration


def _climb(
    manifold: ContactManifold, state: State, settings: HoldSettings, room: ClearRoom | None
) -> list[State]:
    """The states on the way up, without the first one."""
    measure = StrengthMeasure(manifold, settings, state)
    here, step = measure.at(state), _FIRST_STEP
    way: list[State] = []
    values = [here.value]
    while here.value < settings.planned_load and len(way) < _MOST_STEPS:
        give_up_if_asked()
        ascent = measure.gradient(here)
        apart = None if room is None else room.rows(here.state, _NEAR_M)
        there = None
        while there is None and step > _SMALLEST_STEP:
            there = _try_step(manifold, measure, here, ascent, step, apart)
            if there is not None and room is not None and not room.is_clear(there.state):
                there = None
            step = 0.5 * step if there is None else min(1.5 * step, _LARGEST_STEP)
        if there is None:
            break
        here = there
        way.append(here.state)
        values.append(here.value)
        if len(values) > _STALL_STEPS and here.value - values[-1 - _STALL_STEPS] < _STALL * abs(here.value):
            break
    return way


def _try_step(
    manifold: ContactManifold,
    measure: StrengthMeasure,
    here: Strength,
    ascent: Array,
    step: float,
    apart: tuple[Array, Array] | None,
) -> Strength | None:
    """A better state one step on, or None."""
    wish = 3.0 * step * ascent / np.abs(ascent).max(initial=1e-12)
    dx = _bounded_step(manifold, here.state, wish, step, apart=apart)
    state = None if dx is None else _back_on_manifold(manifold, manifold.retract(here.state, dx))
    if state is None:
        return None
    there = measure.at(state)
    return there if there.value > here.value + _LEAST_GAIN else None


def _back_on_manifold(manifold: ContactManifold, state: State) -> State | None:
    """The state projected on the contacts, and pushed into its caps where it has left them."""
    for _ in range(6):
        projected = manifold.project(state)
        if projected is None or manifold.is_feasible(projected):
            return projected
        dx = _bounded_step(manifold, projected, np.zeros(manifold.n_tangent), 0.5, into_caps=True)
        if dx is None:
            return None
        state = manifold.retract(projected, dx)
    return None


def _bounded_step(
    manifold: ContactManifold,
    state: State,
    wish: Array,
    step: float,
    *,
    into_caps: bool = False,
    apart: tuple[Array, Array] | None = None,
) -> Array | None:
    """The step (n_tangent,) nearest to `wish` that keeps contacts, limits and caps to first order.

    A state outside its caps must not leave them farther, and must come back with `into_caps`. Of `apart`, see
    `ClearRoom.rows`, bodies keep their distance.
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
    upper = np.concatenate([high / scale, -c, np.full(len(cap) + len(least_m), 1e6)])
    lower = np.concatenate([low / scale, -c, cap_low, least_m / _LENGTH_M])
    equal = np.zeros(len(upper), dtype=bool)
    equal[n : n + len(c)] = True
    y = solve_quadratic_program(np.eye(n), -wish * scale, rows, lower, upper, equal)
    return None if y is None else y * scale
