"""Bernstein functions in interval arithmetic, by de Casteljau's rule: values, slopes and control points.

The control points of the part over a sub-box bound the function there, by the convex-hull property (paper,
section 4.3).
"""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ..interval import add, mul, scale, sub

__all__ = ["bernstein_range", "bernstein_value", "control_points", "restricted_net", "workspace"]


@compiled
def _mix(lower: Array, upper: Array, count: int, stride: int, width: int, xl: float, xu: float) -> None:
    """One round of de Casteljau at [xl, xu], in place: row a becomes (1 - x) row a + x row a + 1.

    Args:
        lower: the rows' entries, row a beginning at a `stride`.
        upper: likewise.
        count: rows that come out.
        stride: entries from row to row.
        width: entries of a row that count.
        xl: where.
        xu: likewise.
    """
    yl, yu = sub(1.0, 1.0, xl, xu)
    for a in range(count):
        for b in range(width):
            k = a * stride + b
            ul, uu = mul(yl, yu, lower[k], upper[k])
            vl, vu = mul(xl, xu, lower[k + stride], upper[k + stride])
            lower[k], upper[k] = add(ul, uu, vl, vu)


@compiled
def bernstein_value(
    b: Array, di: int, dj: int, il: float, iu: float, jl: float, ju: float, by_i: bool, by_j: bool
) -> tuple[float, float]:
    """Enclosure of a Bernstein function at ([il, iu], [jl, ju]), or of its derivative by x_i or x_j there."""
    w = dj + 1
    cl, cu = b.copy(), b.copy()
    ni, nj = di + 1, dj + 1
    if by_i:
        for a in range(di):
            for c in range(w):
                sl, su = sub(b[(a + 1) * w + c], b[(a + 1) * w + c], b[a * w + c], b[a * w + c])
                cl[a * w + c], cu[a * w + c] = scale(float(di), sl, su)
        ni = di
    if by_j:
        for a in range(ni):
            for c in range(dj):
                sl, su = sub(b[a * w + c + 1], b[a * w + c + 1], b[a * w + c], b[a * w + c])
                cl[a * w + c], cu[a * w + c] = scale(float(dj), sl, su)
        nj = dj
    if ni == 0 or nj == 0:
        return 0.0, 0.0
    for left in range(ni - 1, 0, -1):
        _mix(cl, cu, left, w, nj, il, iu)
    for left in range(nj - 1, 0, -1):
        _mix(cl, cu, left, 1, 1, jl, ju)
    return cl[0], cu[0]


def workspace(degree: Indices) -> Array:
    """Scratch memory that serves all functions of degrees (m, 2)."""
    return np.zeros(6 * int(np.prod(degree + 1, axis=1).max(initial=1)))


@compiled
def control_points(
    coefficients: Array, di: int, dj: int, il: float, iu: float, jl: float, ju: float, work: Array
) -> tuple[Array, Array]:
    """Enclosures (lower, upper) of the control points over [il, iu] x [jl, ju], row by row.

    What is returned lies in `work`.
    """
    return restricted_net(coefficients, coefficients, di, dj, il, iu, jl, ju, work)


@compiled
def restricted_net(
    lower: Array, upper: Array, di: int, dj: int, il: float, iu: float, jl: float, ju: float, work: Array
) -> tuple[Array, Array]:
    """The same of a function whose coefficients are known within [lower, upper].

    Point (p, q) is the blossom with p (q) arguments at the upper end of the first (second) interval and the
    others at the lower.
    """
    n, w = (di + 1) * (dj + 1), dj + 1
    out_l, out_u = work[:n], work[n : 2 * n]
    tl, tu = work[2 * n : 3 * n], work[3 * n : 4 * n]
    cl, cu = work[4 * n : 5 * n], work[5 * n : 6 * n]
    for p in range(di + 1):
        for t in range(n):
            tl[t], tu[t] = lower[t], upper[t]
        for step in range(di):
            x = iu if step < p else il
            _mix(tl, tu, di - step, w, w, x, x)
        for q in range(w):
            for t in range(w):
                cl[t], cu[t] = tl[t], tu[t]
            for step in range(dj):
                x = ju if step < q else jl
                _mix(cl, cu, dj - step, 1, 1, x, x)
            out_l[p * w + q], out_u[p * w + q] = cl[0], cu[0]
    return out_l, out_u


@compiled
def bernstein_range(
    coefficients: Array, di: int, dj: int, il: float, iu: float, jl: float, ju: float, work: Array
) -> tuple[float, float]:
    """Enclosure of a Bernstein function over [il, iu] x [jl, ju], by its control points there."""
    low, high = control_points(coefficients, di, dj, il, iu, jl, ju, work)
    return low.min(), high.max()
