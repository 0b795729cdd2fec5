"""Sliding a grasp to where the hand can hold it.

The solver's configurations make the contacts, no more: the line between two fingertips may lie far outside
their friction cones, or the object's weight may turn it about that line. The contact manifold has more
dimensions than such a grasp needs, so this stage climbs on it, from where the solver stands, until a squeeze
carries the planned load.

Two linear programs measure how good a grasp is, each with the value's derivative by its matrices for free
(for a minimum of c x over A x = b with multipliers y, a change dA changes the value by -y dA x):

1. While no forces inside the friction cones balance each other: the smallest imbalance of contact forces with
   normal components of sum 1, negated. Where the object rests in the hand, because gravity always acts much
   the same way: the smallest imbalance under the weight itself, in N.
2. From there on: the largest load that a squeeze within efforts and cones balances, in multiples of the
   weight; the program of `plan_squeeze` with coarser cones. A turn and a press begin here: their load is
   the torque or the force that is asked for, and a stand holds the object.

Each step solves a quadratic program, ascent within a trust region along the linearised contacts and inside
joint limits, patches and caps, and then returns to the manifold.
"""

from dataclasses import dataclass, replace

import daqp
import numpy as np
from scipy.optimize import linprog

from ...arrays import Array
from ...geometry import rotation_exp
from ...solver import Configuration, ContactManifold, State, certify_state
from ..settings import HoldSettings
from .load_program import LoadProgram, load_program
from .statics import grasp_statics

__all__ = ["strengthen"]


_MOST_STEPS = 40
# A climb ends where so many steps gain less than this share of the value.
_STALL_STEPS, _STALL = 5, 0.03
_FIRST_STEP = 0.2  # rad of joints and pose, share of a patch; positions count per `_LENGTH_M`
_LARGEST_STEP = 0.3
_SMALLEST_STEP = 2e-3
_LENGTH_M = 0.05
_DIFFERENCE = 1e-6
_CONE_SUBDIVISIONS = 1
# Contact forces that are this close to balance are balanced.
_BALANCED = 1e-7
_LEAST_GAIN = 1e-6
# Cap normals are kept this far (in cosine) inside their caps, as the linearisation is not exact.
_CAP_MARGIN = 1e-4
# Joints and patch parameters end up this far inside their limits, where the existence test has room.
_LIMIT_MARGIN = 1e-4
_EQUALITY = 5  # DAQP's mark of a row that always holds


def strengthen(configuration: Configuration, *, settings: HoldSettings | None = None) -> Configuration:
    """The configuration, or one on the same contact manifold whose squeeze carries more.

    It stops at `settings.planned_load` times the weight with the friction that squeezes are best planned
    with, or where steps hardly help. The result is certified anew: where that fails, the last place on the
    way that can be certified is taken.
    """
    settings = settings or HoldSettings()
    manifold = ContactManifold(configuration.task)
    friction = settings.planned_frictions(configuration.task.object)[0]
    way = _climb(manifold, configuration.state, replace(settings, friction=friction))
    for state in reversed(way):
        reached = certify_state(manifold, state)
        if reached.certified or not configuration.certified:
            return reached
    return configuration


def _climb(manifold: ContactManifold, state: State, settings: HoldSettings) -> list[State]:
    """The states on the way up, without the first one."""
    measure = _Measure(manifold, settings)
    here, step = measure.at(state), _FIRST_STEP
    way: list[State] = []
    values = [here.value]
    while here.value < settings.planned_load and len(way) < _MOST_STEPS:
        ascent = measure.gradient(here)
        there = None
        while there is None and step > _SMALLEST_STEP:
            there = _try_step(manifold, measure, here, ascent, step)
            step = 0.5 * step if there is None else min(1.5 * step, _LARGEST_STEP)
        if there is None:
            break
        here = there
        way.append(here.state)
        values.append(here.value)
        if len(values) > _STALL_STEPS and here.value - values[-1 - _STALL_STEPS] < _STALL * abs(here.value):
            break
    return way


@dataclass(frozen=True, eq=False)
class _Measured:
    """A state with its value, and what its derivative needs."""

    state: State
    value: float
    program: LoadProgram
    balanced: bool
    x: Array
    equal: Array  # multipliers of the equations
    upper: Array  # multipliers of the inequalities


class _Measure:
    """How good a state is, and in which direction it gets better."""

    def __init__(self, manifold: ContactManifold, settings: HoldSettings):
        self._manifold = manifold
        self._settings = settings

    def at(self, state: State) -> _Measured:
        """Value of a state: minus the imbalance, or the load factor where forces can balance."""
        program = self._program(state)
        if program.must_balance:
            imbalance = self._unloaded if not np.any(self._settings.resting_direction) else self._loaded
            measured = imbalance(state, program)
            if measured is not None:
                return measured
        A, A_ub = program.A_eq, program.A_ub
        cost = np.zeros(program.n_unknowns)
        cost[-1] = -1.0
        bounds = [(0.0, None)] * (len(cost) - 1) + [(0.0, 2.0 * self._settings.planned_load)]
        result = linprog(cost, A_ub, program.b_ub, A, np.zeros(len(A)), bounds, method="highs")
        if result.status != 0:  # numerical trouble: nothing is known, so nothing is gained
            return _Measured(state, -np.inf, program, True, cost, np.zeros(len(A)), np.zeros(len(A_ub)))
        return _Measured(
            state, -result.fun, program, True, result.x, result.eqlin.marginals, result.ineqlin.marginals
        )

    def _unloaded(self, state: State, program: LoadProgram) -> _Measured | None:
        """The imbalance of forces with normals of sum 1; None where they can balance each other."""
        A, b = _imbalance_rows(program)
        cost = np.concatenate([np.zeros(A.shape[1] - 12), np.ones(12)])
        result = linprog(cost, A_eq=A, b_eq=b, method="highs")
        if result.status != 0 or result.fun <= _BALANCED:
            return None
        none = np.zeros(0)
        return _Measured(state, -result.fun, program, False, result.x, result.eqlin.marginals, none)

    def _loaded(self, state: State, program: LoadProgram) -> _Measured | None:
        """The imbalance under the weight itself, which rests in the hand; None where it can be balanced."""
        m, n = len(program.A_eq), program.n_unknowns
        A = np.column_stack([program.A_eq, np.eye(m), -np.eye(m)])
        A_ub = np.column_stack([program.A_ub, np.zeros((len(program.A_ub), 2 * m))])
        cost = np.concatenate([np.zeros(n), np.ones(2 * m)])
        bounds = [(0.0, None)] * (n - 1) + [(1.0, 1.0)] + [(0.0, None)] * (2 * m)
        result = linprog(cost, A_ub, program.b_ub, A, np.zeros(m), bounds, method="highs")
        if result.status != 0 or result.fun <= _BALANCED:
            return None
        multipliers = result.eqlin.marginals, result.ineqlin.marginals
        return _Measured(state, -result.fun, program, True, result.x[:n], *multipliers)

    def gradient(self, at: _Measured) -> Array:
        """Derivative (n_tangent,) of the value."""
        gradient = np.zeros(self._manifold.n_tangent)
        for k in range(len(gradient)):
            dx = np.zeros(len(gradient))
            dx[k] = _DIFFERENCE
            there = self._program(_moved(self._manifold, at.state, dx))
            gradient[k] = self._change(at, there) / _DIFFERENCE
        return gradient

    def _program(self, state: State) -> LoadProgram:
        task = self._manifold.task
        statics = grasp_statics(Configuration(task, state, 0.0, None), self._settings)
        return load_program(statics, task, state, self._settings, subdivisions=_CONE_SUBDIVISIONS)

    def _change(self, at: _Measured, there: LoadProgram) -> float:
        """First-order change of the value as the program changes to `there`."""
        here = at.program
        if not at.balanced:
            n = there.balance.shape[1]
            return float(at.equal[:6] @ (there.balance - here.balance) @ at.x[:n])
        change = (there.A_eq - here.A_eq) @ at.x
        change_ub = (there.A_ub - here.A_ub) @ at.x
        return float(at.equal @ change + at.upper @ change_ub)


def _imbalance_rows(program: LoadProgram) -> tuple[Array, Array]:
    """Equations of the first program: balance x + r - s = 0, normal forces of sum 1; the cost is r + s."""
    A = np.column_stack([program.balance, np.eye(6), -np.eye(6)])
    normal = np.concatenate([np.ones(program.balance.shape[1]), np.zeros(12)])
    return np.vstack([A, normal]), np.array([0.0] * 6 + [1.0])


def _moved(manifold: ContactManifold, state: State, dx: Array) -> State:
    """The state that a tangent step leads to, limits or not: a derivative must not see them."""
    n = manifold.n_q
    R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
    return State(state.q + dx[:n], R, state.p_palm_object + dx[n : n + 3], state.params + dx[n + 6 :])


def _try_step(
    manifold: ContactManifold, measure: _Measure, here: _Measured, ascent: Array, step: float
) -> _Measured | None:
    """A better state one step on, or None."""
    dx = _bounded_step(manifold, here.state, 3.0 * step * ascent / np.abs(ascent).max(initial=1e-12), step)
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
    manifold: ContactManifold, state: State, wish: Array, step: float, *, into_caps: bool = False
) -> Array | None:
    """The step (n_tangent,) nearest to `wish` that keeps contacts, limits and caps to first order.

    A state outside its caps must not leave them farther, and must come back with `into_caps`.
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
    rows = np.ascontiguousarray(np.vstack([J * scale, J_cap * scale]))
    upper = np.concatenate([high / scale, -c, np.full(len(cap), 1e6)])
    lower = np.concatenate([low / scale, -c, cap_low])
    sense = np.zeros(len(upper), dtype=np.int32)
    sense[n : n + len(c)] = _EQUALITY
    y, _, flag, _ = daqp.solve(np.eye(n), -wish * scale, rows, upper, lower, sense)
    return np.asarray(y) * scale if flag > 0 else None
