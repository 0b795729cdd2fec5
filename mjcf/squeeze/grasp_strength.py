"""How well a state of the contact manifold could hold, and in which direction that gets better.

Two linear programs measure how good a grasp is, each with the value's derivative by its matrices for free
(for a minimum of c x over A x = b with multipliers y, a change dA changes the value by -y dA x):

1. While no forces inside the friction cones balance each other: the smallest imbalance of contact forces with
   normal components of sum 1, negated. Where the object rests in the hand, because gravity always acts much
   the same way: the smallest imbalance under the weight itself, in N.
2. From there on: the largest load that a squeeze within efforts and cones balances, in multiples of the
   weight; the program of `plan_squeeze` with coarser cones. A turn and a press begin here: their load is
   the torque or the force that is asked for, and a stand holds the object.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...geometry import rotation_exp
from ...solver import Configuration, ContactManifold, State
from ..settings import HoldSettings
from .linear_program import Optimum, largest_last, minimise
from .load_program import LoadProgram, load_program
from .pads import contact_pads
from .statics import grasp_statics

__all__ = ["Strength", "StrengthMeasure", "displaced"]

_DIFFERENCE = 1e-6
_CONE_SUBDIVISIONS = 1
# Contact forces that are this close to balance are balanced.
_BALANCED = 1e-7


@dataclass(frozen=True, eq=False)
class Strength:
    """How well a state could hold, and what the derivative of that needs.

    Attributes:
        state: the state.
        value: minus the imbalance, or the load factor where forces can balance.
        program: the linear program of the load there.
        balanced: whether the value was found in terms of `program`; not where it is the imbalance of forces
            without a load.
        optimum: of the linear program that gave the value; None in numerical trouble.
    """

    state: State
    value: float
    program: LoadProgram
    balanced: bool
    optimum: Optimum | None


class StrengthMeasure:
    """How good a state is, and in which direction it gets better.

    Args:
        manifold: the contacts.
        settings: of the test.
        start: where the climb begins; its pads stand for those on the way, as patches change slowly.
    """

    def __init__(self, manifold: ContactManifold, settings: HoldSettings, start: State):
        self._manifold = manifold
        self._settings = settings
        there = Configuration(manifold.task, start, 0.0, None)
        self._spin_arms_m = contact_pads(there, settings).spin_arms_m()

    def at(self, state: State) -> Strength:
        """Value of a state: minus the imbalance, or the load factor where forces can balance."""
        program = self._program(state)
        if program.must_balance:
            imbalance = self._unloaded if not np.any(self._settings.resting_direction) else self._loaded
            measured = imbalance(state, program)
            if measured is not None:
                return measured
        A, A_ub = program.A_eq, program.A_ub
        optimum = largest_last(A, A_ub, program.b_ub, 2.0 * self._settings.planned_load)
        if optimum is None:  # numerical trouble: nothing is known, so nothing is gained
            return Strength(state, -np.inf, program, True, None)
        return Strength(state, -optimum.value, program, True, optimum)

    def _unloaded(self, state: State, program: LoadProgram) -> Strength | None:
        """The imbalance of forces with normals of sum 1; None where they can balance each other."""
        A, b = _imbalance_rows(program)
        cost = np.concatenate([np.zeros(A.shape[1] - 12), np.ones(12)])
        optimum = minimise(cost, A, b)
        if optimum is None or optimum.value <= _BALANCED:
            return None
        return Strength(state, -optimum.value, program, False, optimum)

    def _loaded(self, state: State, program: LoadProgram) -> Strength | None:
        """The imbalance under the weight itself, which rests in the hand; None where it can be balanced."""
        m, n = len(program.A_eq), program.n_unknowns
        A = np.column_stack([program.A_eq, np.eye(m), -np.eye(m)])
        A_ub = np.column_stack([program.A_ub, np.zeros((len(program.A_ub), 2 * m))])
        cost = np.concatenate([np.zeros(n), np.ones(2 * m)])
        optimum = minimise(cost, A, None, A_ub, program.b_ub, bounds={n - 1: (1.0, 1.0)})
        if optimum is None or optimum.value <= _BALANCED:
            return None
        return Strength(state, -optimum.value, program, True, optimum)

    def gradient(self, at: Strength) -> Array:
        """Derivative (n_tangent,) of the value."""
        gradient = np.zeros(self._manifold.n_tangent)
        for k in range(len(gradient)):
            dx = np.zeros(len(gradient))
            dx[k] = _DIFFERENCE
            there = self._program(displaced(self._manifold, at.state, dx))
            gradient[k] = self._change(at, there) / _DIFFERENCE
        return gradient

    def _program(self, state: State) -> LoadProgram:
        task = self._manifold.task
        statics = grasp_statics(Configuration(task, state, 0.0, None), self._settings)
        return load_program(
            statics,
            task,
            state,
            self._settings,
            subdivisions=_CONE_SUBDIVISIONS,
            spin_arms_m=self._spin_arms_m,
        )

    def _change(self, at: Strength, there: LoadProgram) -> float:
        """First-order change of the value as the program changes to `there`."""
        here, optimum = at.program, at.optimum
        if optimum is None:
            return 0.0
        if not at.balanced:
            n = there.balance.shape[1]
            return float(optimum.equal[:6] @ (there.balance - here.balance) @ optimum.x[:n])
        x = optimum.x[: here.n_unknowns]
        change = (there.A_eq - here.A_eq) @ x
        change_ub = (there.A_ub - here.A_ub) @ x
        return float(optimum.equal @ change + optimum.upper @ change_ub)


def _imbalance_rows(program: LoadProgram) -> tuple[Array, Array]:
    """Equations of the first program: balance x + r - s = 0, normal forces of sum 1; the cost is r + s."""
    A = np.column_stack([program.balance, np.eye(6), -np.eye(6)])
    normal = np.concatenate([np.ones(program.balance.shape[1]), np.zeros(12)])
    return np.vstack([A, normal]), np.array([0.0] * 6 + [1.0])


def displaced(manifold: ContactManifold, state: State, dx: Array) -> State:
    """The state that a tangent step leads to, limits or not: a derivative must not see them."""
    n = manifold.n_q
    R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
    return State(state.q + dx[:n], R, state.p_palm_object + dx[n : n + 3], state.params + dx[n + 6 :])
