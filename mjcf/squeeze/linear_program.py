"""Linear programs over unknowns that are at least zero, with the multipliers of their optimum, by HiGHS."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from ...arrays import Array

__all__ = ["Optimum", "largest_last", "minimise"]


@dataclass(frozen=True, eq=False)
class Optimum:
    """The solution of a linear program.

    Attributes:
        x: unknowns (n,).
        value: least cost.
        equal: (m,) derivative of the value by the right-hand sides of the equations.
        upper: (k,) the same for the inequalities.
    """

    x: Array
    value: float
    equal: Array
    upper: Array


def minimise(
    cost: Array,
    A_eq: Array,
    b_eq: Array | None = None,
    A_ub: Array | None = None,
    b_ub: Array | None = None,
    *,
    bounds: Mapping[int, tuple[float, float]] | None = None,
) -> Optimum | None:
    """Least cost @ x with A_eq x = b_eq, A_ub x <= b_ub and x >= 0; None where HiGHS finds none.

    Args:
        cost: (n,).
        A_eq: (m, n).
        b_eq: (m,); None for zeros.
        A_ub: (k, n); None for no inequalities.
        b_ub: (k,) with `A_ub`.
        bounds: least and largest value of single unknowns, in place of at least zero, by their index.
    """
    of_all: list[tuple[float, float | None]] = [(0.0, None)] * len(cost)
    for i, limits in (bounds or {}).items():
        of_all[i] = limits
    b_eq = np.zeros(len(A_eq)) if b_eq is None else b_eq
    result = linprog(cost, A_ub, b_ub, A_eq, b_eq, of_all, method="highs")
    if result.status != 0:
        return None
    return Optimum(result.x, float(result.fun), result.eqlin.marginals, result.ineqlin.marginals)


def largest_last(A_eq: Array, A_ub: Array, b_ub: Array, most: float) -> Optimum | None:
    """The largest last unknown, at most `most`, where A_eq x = 0, A_ub x <= b_ub and x >= 0.

    Its value is that unknown, negated.
    """
    cost = np.zeros(A_eq.shape[1])
    cost[-1] = -1.0
    return minimise(cost, A_eq, None, A_ub, b_ub, bounds={-1: (0.0, most)})
