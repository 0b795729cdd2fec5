"""Small dense systems of equations, compiled: for a few dozen rows a library call takes longest to begin."""

import numpy as np

from ..machine.jit import compiled
from .arrays import Array, Indices

__all__ = ["damped_step", "largest_row", "solve_by_cholesky", "square_inverse", "substitute"]

# Pivots below this share of the largest diagonal entry are rounding.
_LEAST_PIVOT = 1e-15


@compiled
def damped_step(A: Array, r: Array, damping: float, step: Array) -> None:
    """The Levenberg-Marquardt step -A^T (A A^T + damping I)^-1 r: the least-norm step, as damping fades.

    Args:
        A: (m, n)
        r: (m,)
        damping: at least zero; what is left out for it in singular directions, later steps make up for.
        step: (n,) receives the step.
    """
    m, n = A.shape
    L, y = np.empty((m, m)), r.copy()
    largest = 0.0
    for i in range(m):
        for k in range(i + 1):
            total = 0.0
            for j in range(n):
                total += A[i, j] * A[k, j]
            L[i, k] = total
        L[i, i] += damping
        largest = max(largest, L[i, i])
    solve_by_cholesky(L, y, _LEAST_PIVOT * largest)
    for j in range(n):
        step[j] = 0.0
    for i in range(m):
        for j in range(n):
            step[j] -= A[i, j] * y[i]


@compiled
def largest_row(A: Array) -> float:
    """The largest squared norm of a row of A (m, n): the largest entry on the diagonal of A A^T."""
    out = 0.0
    for i in range(A.shape[0]):
        norm = 0.0
        for j in range(A.shape[1]):
            norm += A[i, j] ** 2
        out = max(out, norm)
    return out


@compiled
def solve_by_cholesky(L: Array, y: Array, least_pivot: float) -> None:
    """Solves for y in place; the lower half of the symmetric L (m, m) becomes its factor."""
    m = len(y)
    for k in range(m):
        pivot = np.sqrt(max(L[k, k], least_pivot)) if least_pivot > 0.0 else 1.0
        L[k, k] = pivot
        for i in range(k + 1, m):
            L[i, k] /= pivot
        for i in range(k + 1, m):
            for j in range(k + 1, i + 1):
                L[i, j] -= L[i, k] * L[j, k]
    substitute(L, y, m)


@compiled
def substitute(L: Array, y: Array, m: int) -> None:
    """Solves L L^T x = y for the first m rows of a lower triangular L, in place of y."""
    for i in range(m):
        for j in range(i):
            y[i] -= L[i, j] * y[j]
        y[i] /= L[i, i]
    for i in range(m - 1, -1, -1):
        for j in range(i + 1, m):
            y[i] -= L[j, i] * y[j]
        y[i] /= L[i, i]


@compiled
def square_inverse(J: Array, weight: Array, rows: Indices, columns: Indices, Y: Array) -> bool:
    """Inverse of a well-conditioned square part of J, picked by complete pivoting.

    Args:
        J: (m, n).
        weight: (n,) of columns; columns with a large weight are preferred.
        rows: (k,) with k = min(m, n), receives the rows picked, in the order of the columns.
        columns: (k,) receives the columns picked.
        Y: (k, m) receives the inverse, zero in rows of J that were not picked.

    Returns:
        False where J has less than full rank, to rounding, or its inverse is beyond all floats.
    """
    m, n = J.shape
    k = min(m, n)
    A = np.empty((m, n + m))
    A[:, :n] = J
    A[:, n:] = 0.0
    for e in range(m):
        A[e, n + e] = 1.0
    row_free = np.ones(m, dtype=np.bool_)
    column_free = np.ones(n, dtype=np.bool_)
    first = 0.0
    for step in range(k):
        best, be, bj = 0.0, -1, -1
        for e in range(m):
            if row_free[e]:
                for j in range(n):
                    if column_free[j] and abs(A[e, j]) * weight[j] > best:
                        best, be, bj = abs(A[e, j]) * weight[j], e, j
        if step == 0:
            first = best
        if be < 0 or best <= 1e-13 * first or not np.isfinite(best):
            return False
        rows[step], columns[step] = be, bj
        row_free[be], column_free[bj] = False, False
        pivot = A[be, bj]
        for c in range(n + m):
            A[be, c] /= pivot
        for e in range(m):
            if e != be and A[e, bj] != 0.0:
                factor = A[e, bj]
                for c in range(n + m):
                    A[e, c] -= factor * A[be, c]
    for step in range(k):
        for e in range(m):
            Y[step, e] = A[rows[step], n + e]
            if not np.isfinite(Y[step, e]):
                return False
    return True
