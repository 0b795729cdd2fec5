"""Bernstein functions over a sub-box: enclosures of the control points of the part over it.

By subdivision and the convex-hull property (paper, section 4.3) these bound the function there.
"""

import numpy as np

from ...arrays import Array, Indices
from ..interval import add, jit, mul, sub

__all__ = ["bernstein_range", "control_points", "workspace"]


def workspace(degree: Indices) -> Array:
    """Scratch memory that serves all functions of degrees (m, 2)."""
    return np.zeros(6 * int(np.prod(degree + 1, axis=1).max(initial=1)))


@jit
def control_points(coefficients, di, dj, il, iu, jl, ju, work):  # type: ignore[no-untyped-def]
    """Enclosures (lower, upper) of the control points over [il, iu] x [jl, ju], row by row.

    Point (p, q) is the blossom with p (q) arguments at the upper end of the first (second) interval and the
    others at the lower: de Casteljau's rule in interval arithmetic. What is returned lies in `work`.
    """
    n, w = (di + 1) * (dj + 1), dj + 1
    out_l, out_u = work[:n], work[n : 2 * n]
    tl, tu = work[2 * n : 3 * n], work[3 * n : 4 * n]
    cl, cu = work[4 * n : 5 * n], work[5 * n : 6 * n]
    for p in range(di + 1):
        for t in range(n):
            tl[t], tu[t] = coefficients[t], coefficients[t]
        for step in range(di):
            _mix_rows(tl, tu, di - step, w, iu if step < p else il)
        for q in range(w):
            for t in range(w):
                cl[t], cu[t] = tl[t], tu[t]
            for step in range(dj):
                _mix_rows(cl, cu, dj - step, 1, ju if step < q else jl)
            out_l[p * w + q], out_u[p * w + q] = cl[0], cu[0]
    return out_l, out_u


@jit
def _mix_rows(low, high, rows, width, x):  # type: ignore[no-untyped-def]
    """One round of de Casteljau at x: row a becomes (1 - x) row a + x row a + 1."""
    yl, yu = sub(1.0, 1.0, x, x)
    for a in range(rows):
        for b in range(width):
            k = a * width + b
            ul, uu = mul(yl, yu, low[k], high[k])
            vl, vu = mul(x, x, low[k + width], high[k + width])
            low[k], high[k] = add(ul, uu, vl, vu)


@jit
def bernstein_range(coefficients, di, dj, il, iu, jl, ju, work):  # type: ignore[no-untyped-def]
    """Enclosure of a Bernstein function over [il, iu] x [jl, ju]."""
    low, high = control_points(coefficients, di, dj, il, iu, jl, ju, work)
    return low.min(), high.max()
