"""Linear programs over a relaxation, by HiGHS, with bounds and infeasibility proved afterwards.

HiGHS works in floating point, so nothing it says is believed. A bound on an objective is computed again
from its dual values in outward-rounded arithmetic (Neumaier and Shcherbina, "Safe bounds in linear and
mixed-integer linear programming", 2004), and a box counts as empty only if its dual ray shows it in the
same arithmetic.
"""

from enum import Enum

import highspy
import numpy as np
from numpy.typing import NDArray

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...base.numeric.highs import accept, new_highs
from ..interval import add, scale, sub
from ..polynomial import Rows

__all__ = ["Basis", "LinearProgram", "LpStatus", "dual_bound"]

Basis = NDArray[np.int8]  # of columns and rows, as HiGHS numbers their statuses

_DUAL, _PRIMAL = 1, 4  # HiGHS's simplex strategies
_DANTZIG = 0  # its dual edge weight strategy
_STATUSES = sorted(highspy.HighsBasisStatus.__members__.values(), key=int)


class LpStatus(Enum):
    """How a linear program ended, before anything is proved."""

    OPTIMAL = "optimal"
    INFEASIBLE = "infeasible"
    OTHER = "other"


class LinearProgram:
    """One HiGHS instance that is fed box after box."""

    def __init__(self, n_columns: int):
        # Without presolve: where it finds infeasibility, it gives no ray.
        self._highs = new_highs()
        accept(self._highs.setOptionValue("simplex_iteration_limit", 5000))
        # Coefficients are near 1 by the formulation's units; HiGHS's scaling doubles the iterations.
        accept(self._highs.setOptionValue("simplex_scale_strategy", 0))
        # Edge weights don't come with a basis, and to compute them takes longer than they save.
        accept(self._highs.setOptionValue("simplex_dual_edge_weight_strategy", _DANTZIG))
        self._n = n_columns
        self._cost = np.zeros(n_columns)
        self._rows: Rows | None = None
        self._lower = self._upper = np.zeros(n_columns)
        self.solved = 0
        # The duals or the ray by which the last bound or infeasibility was proved.
        self.certificate = np.zeros(0)

    def load(self, rows: Rows, lower: Array, upper: Array, basis: Basis | None = None) -> None:
        """Takes the rows and the box of the next relaxation, and the basis to start from."""
        n_rows, n_entries = len(rows.lower), len(rows.value)
        by_rows, minimise = int(highspy.MatrixFormat.kRowwise), int(highspy.ObjSense.kMinimize)
        accept(
            self._highs.passModel(
                self._n, n_rows, n_entries, by_rows, minimise, 0.0,
                np.zeros(self._n), lower, upper, rows.lower, rows.upper,
                rows.start[:-1].astype(np.int32), rows.column.astype(np.int32), rows.value,
                np.zeros(self._n, dtype=np.int32),
            )
        )  # fmt: skip
        if basis is not None:
            start = highspy.HighsBasis()
            statuses = [_STATUSES[s] for s in basis]
            start.col_status, start.row_status = statuses[: self._n], statuses[self._n :]
            accept(self._highs.setBasis(start))
        self._rows, self._lower, self._upper = rows, lower.copy(), upper.copy()
        self._cost[:] = 0.0

    def minimise(self, column: int | None, sign: float = 1.0) -> LpStatus:
        """Minimises sign * x_column, or looks for any feasible point where `column` is None."""
        old = np.flatnonzero(self._cost)
        for j in old:
            accept(self._highs.changeColCost(int(j), 0.0))
        self._cost[:] = 0.0
        # A new box leaves the old basis dual feasible, a new objective leaves it primal feasible.
        accept(self._highs.setOptionValue("simplex_strategy", _DUAL if column is None else _PRIMAL))
        if column is not None:
            self._cost[column] = sign
            accept(self._highs.changeColCost(int(column), float(sign)))
        self._highs.run()
        self.solved += 1
        status = self._highs.getModelStatus()
        if status == highspy.HighsModelStatus.kOptimal:
            return LpStatus.OPTIMAL
        if status == highspy.HighsModelStatus.kInfeasible:
            return LpStatus.INFEASIBLE
        return LpStatus.OTHER

    @property
    def basis(self) -> Basis | None:
        """The basis (n + n_rows,) of the last run, None where it has none."""
        last = self._highs.getBasis()
        if not last.valid:
            return None
        return np.array([int(s) for s in (*last.col_status, *last.row_status)], dtype=np.int8)

    @property
    def point(self) -> Array:
        """The primal point (n,) of the last run; an approximation."""
        return np.array(self._highs.getSolution().col_value)

    def proved_bound(self) -> float:
        """A proved lower bound on the last objective, from its dual values; -inf where there is none."""
        assert self._rows is not None
        duals = np.array(self._highs.getSolution().row_dual)
        if len(duals) != len(self._rows.lower) or not np.isfinite(duals).all():
            return -np.inf
        self.certificate = duals
        return float(dual_bound(self._cost, duals, self._rows, self._lower, self._upper))

    def proved_infeasible(self) -> bool:
        """Whether the dual ray of the last run proves that no point of the box satisfies the rows."""
        assert self._rows is not None
        found = self._highs.getDualRay()
        ray = np.array(found[-1]) if found[1] else np.zeros(0)
        if len(ray) != len(self._rows.lower) or not np.isfinite(ray).all():
            return False
        zero = np.zeros(self._n)
        # Rays come with either sign, depending on the simplex that found them.
        for self.certificate in (ray, -ray):
            if dual_bound(zero, self.certificate, self._rows, self._lower, self._upper) > 0.0:
                return True
        return False


@compiled
def dual_bound(cost: Array, duals: Array, rows: Rows, lower: Array, upper: Array) -> float:
    """A lower bound on cost . x over the rows and lower <= x <= upper, for any duals.

    For every y: cost . x = y . (A x) + (cost - A^T y) . x, and both terms are bounded in interval arithmetic.
    Duals that point to a missing side of a row are dropped.
    """
    start, column, value, row_lower, row_upper = rows
    n = len(lower)
    reduced_lower, reduced_upper = cost.copy(), cost.copy()
    bound = 0.0
    for r in range(len(row_lower)):
        y = duals[r]
        side = row_lower[r] if y > 0.0 else row_upper[r]
        if y == 0.0 or not np.isfinite(side):
            continue
        low = scale(y, side, side)[0]
        bound = add(bound, bound, low, low)[0]
        for t in range(start[r], start[r + 1]):
            j = column[t]
            pl, pu = scale(y, value[t], value[t])
            reduced_lower[j], reduced_upper[j] = sub(reduced_lower[j], reduced_upper[j], pl, pu)
    for j in range(n):
        low = np.inf
        for d in (reduced_lower[j], reduced_upper[j]):
            for x in (lower[j], upper[j]):
                low = min(low, scale(d, x, x)[0])
        bound = add(bound, bound, low, low)[0]
    return bound
