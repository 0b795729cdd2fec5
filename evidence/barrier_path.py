"""The path of a logarithmic barrier over cones and rows, compiled: load by load, to the largest slack.

Newton's method from weight to weight of the objective (Boyd & Vandenberghe, "Convex optimization", 2004,
section 11.3). A path ends strictly inside whatever the rounding.
"""

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array
from ..base.numeric.linalg import solve_by_cholesky

__all__ = ["follow_paths"]

_GROWTH, _MOST_STEPS, _MOST_HALVINGS = 8.0, 120, 40
# Half the square of Newton's decrement below which a point counts as on the path.
_ON_PATH = 0.05
# The largest value is above that of a point on the path by the path's gap, near it by no more than so many.
_NEAR_GAP = 2.0
_LEAST_PIVOT = 1e-15


@compiled
def follow_paths(B: Array, g: Array, a: Array, h: Array, least_gap: float, z: Array) -> int:
    """Largest z_last with |(B z + g)_1..3| < (B z + g)_0 at every point and a z + h > 0, for each load.

    Args:
        B: (m, 4, d) of m cones.
        g: (k, m, 4) for each of k loads.
        a: (rows, d)
        h: (k, rows)
        least_gap: how near to the largest it ends.
        z: (k, d) points strictly inside; receives the ends.

    Returns:
        How many loads have their end: up to the first that surely has none above zero.
    """
    m, _, d = B.shape
    loads, rows = h.shape
    # Of a point, the Hessian of its cone's quadratic form, but for a factor.
    curved = np.zeros((m, d, d))
    for p in range(m):
        for i in range(d):
            for j in range(i + 1):
                curved[p, i, j] = (
                    B[p, 0, i] * B[p, 0, j]
                    - B[p, 1, i] * B[p, 1, j]
                    - B[p, 2, i] * B[p, 2, j]
                    - B[p, 3, i] * B[p, 3, j]
                )
    v, r = np.empty((m, 4)), np.empty(rows)
    H, step, gradient, there = np.empty((d, d)), np.empty(d), np.empty(d), np.empty(d)
    for k in range(loads):
        weight = 1.0
        here = _value(B, g[k], a, h[k], z[k], weight, v, r)
        for _ in range(_MOST_STEPS):
            _derivatives(B, a, curved, v, r, gradient, H)
            gradient[d - 1] -= weight
            largest = 0.0
            for i in range(d):
                step[i] = -gradient[i]
                largest = max(largest, H[i, i])
            solve_by_cholesky(H, step, _LEAST_PIVOT * largest)
            decrement = 0.0
            for i in range(d):
                decrement -= 0.5 * gradient[i] * step[i]
            length = 1.0
            for _ in range(_MOST_HALVINGS):
                for i in range(d):
                    there[i] = z[k, i] + length * step[i]
                value = _value(B, g[k], a, h[k], there, weight, v, r)
                if value <= here + 1e-9 * abs(here):
                    z[k] = there
                    break
                length *= 0.5
            if decrement < _ON_PATH:
                gap = (2 * m + rows) / weight
                if z[k, d - 1] + _NEAR_GAP * gap < 0.0:
                    return k + 1
                if gap < least_gap:
                    break
                weight *= _GROWTH
            here = _value(B, g[k], a, h[k], z[k], weight, v, r)
    return loads


@compiled
def _value(B: Array, g: Array, a: Array, h: Array, z: Array, weight: float, v: Array, r: Array) -> float:
    """Barrier and objective at z (d,), infinite outside; v (m, 4) and r (rows,) receive what is there."""
    m, _, d = B.shape
    out = -weight * z[d - 1]
    inside = True
    for p in range(m):
        for c in range(4):
            total = g[p, c]
            for i in range(d):
                total += B[p, c, i] * z[i]
            v[p, c] = total
        q = v[p, 0] ** 2 - v[p, 1] ** 2 - v[p, 2] ** 2 - v[p, 3] ** 2
        if v[p, 0] > 0.0 and q > 0.0:
            out -= np.log(q)
        else:
            inside = False
    for j in range(len(r)):
        total = h[j]
        for i in range(d):
            total += a[j, i] * z[i]
        r[j] = total
        if total > 0.0:
            out -= np.log(total)
        else:
            inside = False
    return out if inside else np.inf


@compiled
def _derivatives(B: Array, a: Array, curved: Array, v: Array, r: Array, gradient: Array, H: Array) -> None:
    """Gradient (d,) and the lower half of the Hessian (d, d) of the barrier without the objective."""
    m, _, d = B.shape
    gradient[:] = 0.0
    H[:] = 0.0
    slope = np.empty(d)
    for p in range(m):
        q = v[p, 0] ** 2 - v[p, 1] ** 2 - v[p, 2] ** 2 - v[p, 3] ** 2
        for i in range(d):
            # Half the derivative of q.
            slope[i] = v[p, 0] * B[p, 0, i]
            for c in range(1, 4):
                slope[i] -= v[p, c] * B[p, c, i]
            gradient[i] -= 2.0 * slope[i] / q
        outer, bent = 4.0 / q**2, -2.0 / q
        for i in range(d):
            for j in range(i + 1):
                H[i, j] += outer * slope[i] * slope[j] + bent * curved[p, i, j]
    for k in range(len(r)):
        share = 1.0 / r[k]
        for i in range(d):
            gradient[i] -= share * a[k, i]
            along = share**2 * a[k, i]
            for j in range(i + 1):
                H[i, j] += along * a[k, j]
