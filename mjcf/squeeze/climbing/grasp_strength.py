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

from dataclasses import replace

import numpy as np

from ....base.numeric.arrays import Array
from ....solver import ContactManifold, State
from ...settings import HoldSettings
from ..linear_program import Optimum, largest_last, minimise
from ..load_program import LoadProgram
from ..sparse_rows import SparseRows
from ..statics import Statics
from .grasp_measure import ProgramAt, Strength
from .program_slope import imbalance_slope, load_slope

__all__ = ["StrengthMeasure"]

# Contact forces that are this close to balance are balanced.
_BALANCED = 1e-7
# A load factor that is no rounding.
_SOME_LOAD = 0.01


class StrengthMeasure:
    """How good a state is, and in which direction it gets better.

    Args:
        manifold: the contacts.
        settings: of the test.
        start: where the climb begins; see `ProgramAt`.
    """

    def __init__(self, manifold: ContactManifold, settings: HoldSettings, start: State):
        self._manifold = manifold
        self._settings = settings
        self._program_at = ProgramAt(manifold, settings, start)
        # The last optimum of each program: states come one near the other.
        self._imbalance: Optimum | None = None
        self._rest: Optimum | None = None
        self._load: Optimum | None = None
        self._rests = bool(np.any(settings.resting_direction))
        # From which load on it is known that forces balance: what rests in the hand is balanced where its
        # weight is carried; else forces against a load and against its opposite balance each other.
        opposite = all(tuple(-x for x in way) in settings.directions for way in settings.directions)
        self._balanced_from = 1.0 if self._rests else _SOME_LOAD if opposite else np.inf
        # Whether the last state carried that.
        self._carried = False

    def begin_at(self, start: State) -> None:
        """Goes on from another state, whose pads then count."""
        self._program_at.begin_at(start)

    def at(self, state: State) -> Strength:
        """Value of a state: minus the imbalance, or the load factor where forces can balance."""
        statics, program = self._program_at(state)
        strength = None
        if self._carried:  # most likely still
            strength = self._of_load(state, statics, program)
            if strength.value >= self._balanced_from:
                return strength
        if program.must_balance:
            imbalance = self._loaded if self._rests else self._unloaded
            measured = imbalance(state, statics, program)
            if measured is not None:
                self._carried = False
                return measured
        strength = strength or self._of_load(state, statics, program)
        self._carried = strength.value >= self._balanced_from
        return strength

    def _of_load(self, state: State, statics: Statics, program: LoadProgram) -> Strength:
        """The largest load up to twice the planned one."""
        rows, most = program.rows, 2.0 * self._settings.planned_load
        optimum = largest_last(rows.A_eq, rows.A_ub, rows.b_ub, most, start=self._load)
        self._load = optimum or self._load
        if optimum is None:  # numerical trouble: nothing is known, so nothing is gained
            return Strength(state, statics, -np.inf, program, True, None)
        return Strength(state, statics, -optimum.value, program, True, optimum)

    def _unloaded(self, state: State, statics: Statics, program: LoadProgram) -> Strength | None:
        """The imbalance of forces with normals of sum 1; None where they can balance each other."""
        A, b = _imbalance_rows(program)
        cost = np.concatenate([np.zeros(A.shape[1] - 12), np.ones(12)])
        optimum = minimise(cost, A, b, start=self._imbalance)
        self._imbalance = optimum or self._imbalance
        if optimum is None or optimum.value <= _BALANCED:
            return None
        return Strength(state, statics, -optimum.value, program, False, optimum)

    def _loaded(self, state: State, statics: Statics, program: LoadProgram) -> Strength | None:
        """The imbalance under the weight itself, which rests in the hand; None where it can be balanced."""
        rows = program.rows
        m, n = len(rows.A_eq), program.n_unknowns
        either_way = SparseRows.of(np.column_stack([np.eye(m), -np.eye(m)]))
        A, A_ub = rows.A_eq.beside(either_way), replace(rows.A_ub, n_columns=n + 2 * m)
        cost = np.concatenate([np.zeros(n), np.ones(2 * m)])
        optimum = minimise(cost, A, None, A_ub, rows.b_ub, bounds={n - 1: (1.0, 1.0)}, start=self._rest)
        self._rest = optimum or self._rest
        if optimum is None or optimum.value <= _BALANCED:
            return None
        return Strength(state, statics, -optimum.value, program, True, optimum)

    def gradient(self, at: Strength) -> Array:
        """Derivative (n_tangent,) of the value."""
        if at.optimum is None:
            return np.zeros(self._manifold.n_tangent)
        if not at.balanced:
            vector = at.program.edges @ at.optimum.x[: at.program.edges.shape[1]]
            return imbalance_slope(self._manifold, at.state, at.statics, vector, at.optimum.equal[:6])
        return load_slope(self._manifold, self._settings, at.state, at.statics, at.program, at.optimum)


def _imbalance_rows(program: LoadProgram) -> tuple[Array, Array]:
    """Equations of the first program: balance x + r - s = 0, normal forces of sum 1; the cost is r + s."""
    A = np.column_stack([program.balance, np.eye(6), -np.eye(6)])
    normal = np.concatenate([np.ones(program.balance.shape[1]), np.zeros(12)])
    return np.vstack([A, normal]), np.array([0.0] * 6 + [1.0])
