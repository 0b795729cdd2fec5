"""A small dense simplex method for linear programs with bounded variables, inside compiled loops.

Programs of a few dozen rows, solved a million times: minimise c . z over A z = b, 0 <= z <= upper. Everything
is floating point and nothing is proved; whoever uses the dual values proves what follows from them.
"""

import numpy as np

from .rounding import jit

__all__ = ["AT_LOWER", "AT_UPPER", "BASIC", "dual_values", "feasible_basis", "minimise", "reduced_costs"]

AT_LOWER, BASIC, AT_UPPER = 0, 1, 2

_TOLERANCE = 1e-9
_MOST_STEPS = 400


@jit
def minimise(T, beta, upper, basis, status, d, enterable, value, enough):  # type: ignore[no-untyped-def]
    """Primal simplex steps from a feasible basis, all in place.

    Args:
        T: (rows, columns) B^-1 A.
        beta: (rows,) values of the basic variables.
        upper: (columns,) upper bounds, inf where there is none.
        basis: (rows,) basic variable of each row.
        status: (columns,) BASIC, AT_LOWER or AT_UPPER.
        d: (columns,) reduced costs.
        enterable: columns from this one on never enter.
        value: objective at this basis.
        enough: an objective that need not be improved on.

    Returns:
        The objective in the end, with which the program is at its optimum or `enough` was reached; -inf where
        there is no optimum; inf where the steps ran out.
    """
    rows, columns = T.shape
    for step in range(_MOST_STEPS):
        # The steepest price; the first one that pays when it has gone on for long, so as not to cycle.
        best, j = _TOLERANCE, -1
        for c in range(enterable):
            price = -d[c] if status[c] == AT_LOWER else (d[c] if status[c] == AT_UPPER else 0.0)
            if price > best and upper[c] > 0.0:
                best, j = price, c
                if 2 * step > _MOST_STEPS:
                    break
        if j < 0 or value <= enough:
            return value
        sign = 1.0 if status[j] == AT_LOWER else -1.0
        length, row, size = upper[j], -1, 0.0
        for r in range(rows):
            a = sign * T[r, j]
            if a > _TOLERANCE:
                room = max(beta[r], 0.0) / a
            elif a < -_TOLERANCE and upper[basis[r]] < np.inf:
                room = max(upper[basis[r]] - beta[r], 0.0) / -a
            else:
                continue
            if room < length - 1e-12 or (room <= length + 1e-12 and abs(a) > size):
                length, row, size = min(room, length), r, abs(a)
        if length == np.inf:
            return -np.inf
        value -= best * length
        for r in range(rows):
            beta[r] -= sign * length * T[r, j]
        if row < 0:
            status[j] = AT_UPPER if status[j] == AT_LOWER else AT_LOWER
            continue
        left = basis[row]
        status[left] = AT_LOWER if sign * T[row, j] > 0.0 else AT_UPPER
        beta[row] = length if sign > 0.0 else upper[j] - length
        basis[row], status[j] = j, BASIC
        T[row] /= T[row, j]
        for r in range(rows):
            factor = T[r, j]
            if r != row and factor != 0.0:
                for c in range(columns):
                    T[r, c] -= factor * T[row, c]
        factor = d[j]
        for c in range(columns):
            d[c] -= factor * T[row, c]
    return np.inf


@jit
def reduced_costs(T, basis, cost, d):  # type: ignore[no-untyped-def]
    """Writes cost - cost_B B^-1 A into d (columns,)."""
    d[:] = cost
    for r in range(len(basis)):
        factor = cost[basis[r]]
        if factor != 0.0:
            for c in range(len(d)):
                d[c] -= factor * T[r, c]


@jit
def feasible_basis(T, beta, upper, basis, status, d):  # type: ignore[no-untyped-def]
    """Phase one from the artificial variables, which are the last columns, one for each row.

    Rows come with a right-hand side `beta` >= 0 and the unit matrix in the artificial columns.

    Returns:
        The sum of infeasibilities that is left; afterwards artificial variables are fixed at zero.
    """
    rows, columns = T.shape
    real = columns - rows
    for c in range(columns):
        status[c] = AT_LOWER
        d[c] = 0.0
    for r in range(rows):
        basis[r] = real + r
        status[real + r] = BASIC
        for c in range(real):
            d[c] -= T[r, c]
    minimise(T, beta, upper, basis, status, d, real, beta.sum(), 0.0)
    left = 0.0
    for r in range(rows):
        if basis[r] >= real:
            left += max(beta[r], 0.0)
        upper[real + r] = 0.0
    return left


@jit
def dual_values(d, cost_of_artificials, y):  # type: ignore[no-untyped-def]
    """Writes the dual value of each row into y (rows,), from the reduced costs of the artificial columns."""
    real = len(d) - len(y)
    for r in range(len(y)):
        y[r] = cost_of_artificials - d[real + r]
