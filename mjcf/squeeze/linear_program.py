"""Linear programs over unknowns that are at least zero, with the multipliers of their optimum, by HiGHS."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import highspy
import numpy as np

from ...base.numeric.arrays import Array
from ...base.numeric.highs import accept, new_highs
from .sparse_rows import SparseRows

__all__ = ["Optimum", "Rows", "largest_last", "minimise"]

Rows: TypeAlias = Array | SparseRows
"""A matrix: large ones by entries that are not zero."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """The solution of a linear program.

    Attributes:
        x: unknowns (n,).
        value: least cost.
        equal: (m,) derivative of the value by the right-hand sides of the equations.
        upper: (k,) the same for the inequalities.
        basis: of HiGHS, where a program of the same shape may start.
    """

    x: Array
    value: float
    equal: Array
    upper: Array
    basis: highspy.HighsBasis


class _Solvers(threading.local):
    """Instances of HiGHS for each thread: to make one takes longer than to solve a small program.

    Attributes:
        usual: as it comes.
        fast: without scaling rows, which are of one size already, and without shaking costs, which takes
            longer than it saves near the optimum of a program like it. Of several optima it may find another.
    """

    def __init__(self) -> None:
        self.usual, self.fast = new_highs(), new_highs()
        accept(self.fast.setOptionValue("simplex_scale_strategy", 0))
        accept(self.fast.setOptionValue("dual_simplex_cost_perturbation_multiplier", 0.0))
        # Unscaled, small slopes of large unknowns count.
        accept(self.fast.setOptionValue("dual_feasibility_tolerance", 1e-9))


_solvers = _Solvers()


def minimise(
    cost: Array,
    A_eq: Rows,
    b_eq: Array | None = None,
    A_ub: Rows | None = None,
    b_ub: Array | None = None,
    *,
    bounds: Mapping[int, tuple[float, float]] | None = None,
    start: Optimum | None = None,
    any_optimum: bool = True,
) -> Optimum | None:
    """Least cost @ x with A_eq x = b_eq, A_ub x <= b_ub and x >= 0; None where HiGHS finds none.

    Args:
        cost: (n,).
        A_eq: (m, n).
        b_eq: (m,); None for zeros.
        A_ub: (k, n); None for no inequalities.
        b_ub: (k,) with `A_ub`.
        bounds: least and largest value of single unknowns, in place of at least zero, by their index.
        start: optimum of a similar program. One of the same shape saves most of the work, any other one is
            of no use.
        any_optimum: whether any one will do where there are several; False for programs whose unknowns count
            and not their value alone, so that these stay what they are however programs are solved.
    """
    m, n = len(A_eq), len(cost)
    least, most = np.zeros(n), np.full(n, np.inf)
    for i, limits in (bounds or {}).items():
        least[i], most[i] = limits
    b_eq = np.zeros(m) if b_eq is None else b_eq
    b_ub = np.zeros(0) if A_ub is None or b_ub is None else b_ub
    rows = _sparse(A_eq) if A_ub is None else SparseRows.stacked(_sparse(A_eq), _sparse(A_ub))
    lower, upper = np.concatenate([b_eq, np.full(len(b_ub), -np.inf)]), np.concatenate([b_eq, b_ub])
    highs = _solvers.fast if any_optimum else _solvers.usual
    _pass(highs, cost, rows, (lower, upper), (least, most))
    if start is not None and (len(start.x), len(start.equal) + len(start.upper)) == (n, len(rows)):
        accept(highs.setBasis(start.basis))
    highs.run()
    status = highs.getModelStatus()
    if status not in (highspy.HighsModelStatus.kOptimal, highspy.HighsModelStatus.kInfeasible):
        # Numerical trouble, which presolve may help.
        accept(highs.clearSolver())
        accept(highs.setOptionValue("presolve", "on"))
        highs.run()
        accept(highs.setOptionValue("presolve", "off"))
        status = highs.getModelStatus()
    if status != highspy.HighsModelStatus.kOptimal:
        return None
    solution = highs.getSolution()
    x, duals = np.array(solution.col_value), np.array(solution.row_dual)
    return Optimum(x, float(cost @ x), duals[:m], duals[m:], highs.getBasis())


def _sparse(rows: Rows) -> SparseRows:
    return rows if isinstance(rows, SparseRows) else SparseRows.of(rows)


def _pass(
    highs: highspy.Highs,
    cost: Array,
    rows: SparseRows,
    of_rows: tuple[Array, Array],
    of_unknowns: tuple[Array, Array],
) -> None:
    """Gives HiGHS a program; limits are (least, largest)."""
    m, n = len(rows), rows.n_columns
    by_rows, minimum = int(highspy.MatrixFormat.kRowwise), int(highspy.ObjSense.kMinimize)
    accept(
        highs.passModel(
            n, m, len(rows.values), by_rows, minimum, 0.0,
            cost, *of_unknowns, *of_rows,
            rows.starts[:-1], rows.columns, rows.values,
            np.zeros(n, dtype=np.int32),
        )
    )  # fmt: skip


def largest_last(
    A_eq: Rows, A_ub: Rows, b_ub: Array, most: float, *, start: Optimum | None = None
) -> Optimum | None:
    """The largest last unknown, at most `most`, where A_eq x = 0, A_ub x <= b_ub and x >= 0.

    Its value is that unknown, negated; `start` as for `minimise`.
    """
    cost = np.zeros(A_eq.n_columns if isinstance(A_eq, SparseRows) else A_eq.shape[1])
    cost[-1] = -1.0
    return minimise(cost, A_eq, None, A_ub, b_ub, bounds={-1: (0.0, most)}, start=start)
