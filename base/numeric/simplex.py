"""A small revised simplex method for linear programs with bounded variables, inside compiled loops.

Programs of a few dozen rows and some hundred columns, solved a million times: minimise c . z over A z = b,
0 <= z <= upper. The inverse of the basis is kept, and reduced costs are computed anew at each step, which is
half the work of updating a tableau. Everything is floating point and nothing is proved; whoever uses the
dual values proves what follows from them.

Behind the columns of A there is an artificial variable for each row, with the unit matrix for its columns.
"""

from typing import NamedTuple

import numpy as np

from ..machine.jit import compiled
from .arrays import Array, Indices

__all__ = ["AT_LOWER", "AT_UPPER", "BASIC", "Tableau", "feasible_basis", "minimise"]

AT_LOWER, BASIC, AT_UPPER = 0, 1, 2

_TOLERANCE = 1e-9
_MOST_STEPS = 400


class Tableau(NamedTuple):
    """A program and where it stands.

    Attributes:
        A: (rows, columns) the constraints, which stay as they are.
        upper: (columns + rows,) upper bounds, inf where there is none.
        inverse: (rows, rows) of the basis' columns.
        beta: (rows,) values of the basic variables.
        basis: (rows,) basic variable of each row.
        status: (columns + rows,) BASIC, AT_LOWER or AT_UPPER.
        y: (rows,) the dual values.
    """

    A: Array
    upper: Array
    inverse: Array
    beta: Array
    basis: Indices
    status: Indices
    y: Array


@compiled
def minimise(t: Tableau, cost: Array, value: float, enough: float) -> float:
    """Primal simplex steps from a feasible basis, all in place; artificial variables never enter.

    Args:
        t: the program.
        cost: (columns + rows,)
        value: objective at this basis.
        enough: an objective that need not be improved on.

    Returns:
        The objective in the end, with which the program is at its optimum or `enough` was reached; -inf where
        there is no optimum; inf where the steps ran out.
    """
    A, upper, inverse, beta, basis, status, y = t
    rows, columns = A.shape
    d, alpha, gains = np.empty(columns), np.empty(rows), np.empty(columns + rows)
    for c in range(columns + rows):
        gains[c] = _gain(status[c], upper[c])
    for step in range(_MOST_STEPS):
        _dual_values(inverse, basis, cost, y)
        _reduced_costs(A, y, cost, d)
        # The steepest price; the first one that pays when it has gone on for long, so as not to cycle.
        price, j = _first_price(d, gains) if 2 * step > _MOST_STEPS else _steepest_price(d, gains)
        if j < 0 or value <= enough:
            return value
        sign = 1.0 if status[j] == AT_LOWER else -1.0
        for r in range(rows):
            alpha[r] = 0.0
            for k in range(rows):
                alpha[r] += inverse[r, k] * A[k, j]
        length, row = _step_length(alpha, sign, beta, upper, basis, upper[j])
        if length == np.inf:
            return -np.inf
        value -= price * length
        for r in range(rows):
            beta[r] -= sign * length * alpha[r]
        if row < 0:
            status[j] = AT_UPPER if status[j] == AT_LOWER else AT_LOWER
            gains[j] = -gains[j]
            continue
        left = basis[row]
        status[left] = AT_LOWER if sign * alpha[row] > 0.0 else AT_UPPER
        gains[left] = _gain(status[left], upper[left])
        beta[row] = length if sign > 0.0 else upper[j] - length
        basis[row], status[j], gains[j] = j, BASIC, 0.0
        _pivot(inverse, alpha, row)
    return np.inf


@compiled
def _gain(status: int, upper: float) -> float:
    """What a reduced cost is to be multiplied by for the price: 0 for a variable that can't move."""
    if status == BASIC or not upper > 0.0:
        return 0.0
    return -1.0 if status == AT_LOWER else 1.0


@compiled
def _dual_values(inverse: Array, basis: Indices, cost: Array, y: Array) -> None:
    """Writes cost_B B^-1 into y (rows,)."""
    y[:] = 0.0
    for r in range(len(basis)):
        factor = cost[basis[r]]
        if factor != 0.0:
            for k in range(len(y)):
                y[k] += factor * inverse[r, k]


@compiled
def _reduced_costs(A: Array, y: Array, cost: Array, d: Array) -> None:
    """Writes cost - y A into d (columns,), several rows at a time, so that d is run through less often."""
    rows, columns = A.shape
    d[:] = cost[:columns]
    r = 0
    while r + 3 < rows:
        y0, y1, y2, y3 = y[r], y[r + 1], y[r + 2], y[r + 3]
        a0, a1, a2, a3 = A[r], A[r + 1], A[r + 2], A[r + 3]
        for c in range(columns):
            d[c] -= (y0 * a0[c] + y1 * a1[c]) + (y2 * a2[c] + y3 * a3[c])
        r += 4
    while r < rows:
        y0, a0 = y[r], A[r]
        for c in range(columns):
            d[c] -= y0 * a0[c]
        r += 1


@compiled
def _first_price(d: Array, gains: Array) -> tuple[float, int]:
    """Price and number of the first variable that pays, -1 where none does."""
    for c in range(len(d)):
        if d[c] * gains[c] > _TOLERANCE:
            return d[c] * gains[c], c
    return 0.0, -1


@compiled
def _steepest_price(d: Array, gains: Array) -> tuple[float, int]:
    """Price and number of the variable that pays most, -1 where none does."""
    # Two halves at a time, which don't wait for each other.
    half = len(d) // 2
    best0, j0, best1, j1 = _TOLERANCE, -1, _TOLERANCE, -1
    for c in range(half):
        price0, price1 = d[c] * gains[c], d[half + c] * gains[half + c]
        if price0 > best0:
            best0, j0 = price0, c
        if price1 > best1:
            best1, j1 = price1, half + c
    for c in range(2 * half, len(d)):
        if d[c] * gains[c] > best1:
            best1, j1 = d[c] * gains[c], c
    return (best1, j1) if best1 > best0 else (best0, j0)


@compiled
def _step_length(
    alpha: Array, sign: float, beta: Array, upper: Array, basis: Indices, length: float
) -> tuple[float, int]:
    """How far a variable can move, at most `length`, and the row that stops it, -1 for none."""
    row, size = -1, 0.0
    for r in range(len(alpha)):
        a = sign * alpha[r]
        if a > _TOLERANCE:
            room = max(beta[r], 0.0) / a
        elif a < -_TOLERANCE and upper[basis[r]] < np.inf:
            room = max(upper[basis[r]] - beta[r], 0.0) / -a
        else:
            continue
        if room < length - 1e-12 or (room <= length + 1e-12 and abs(a) > size):
            length, row, size = min(room, length), r, abs(a)
    return length, row


@compiled
def _pivot(inverse: Array, alpha: Array, row: int) -> None:
    """Makes the inverse that of the basis with the column `inverse`^-1 alpha in the place of one row's."""
    source = inverse[row]
    source /= alpha[row]
    for r in range(len(alpha)):
        if r != row and alpha[r] != 0.0:
            target, factor = inverse[r], alpha[r]
            for k in range(len(alpha)):
                target[k] -= factor * source[k]


@compiled
def feasible_basis(t: Tableau) -> float:
    """Phase one: from the artificial variables, for rows whose right-hand side >= 0 `beta` holds.

    Returns:
        The sum of infeasibilities that is left, of which `y` holds the dual values; afterwards artificial
        variables are fixed at zero.
    """
    A, upper, inverse, beta, basis, status, _ = t
    rows, columns = A.shape
    cost = np.zeros(columns + rows)
    inverse[:] = 0.0
    status[:] = AT_LOWER
    for r in range(rows):
        cost[columns + r] = inverse[r, r] = 1.0
        basis[r] = columns + r
        status[columns + r] = BASIC
    minimise(t, cost, beta.sum(), 0.0)
    left = 0.0
    for r in range(rows):
        if basis[r] >= columns:
            left += max(beta[r], 0.0)
        upper[columns + r] = 0.0
    return left
