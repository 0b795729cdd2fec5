"""Points and inward normals of charts, with derivatives, for local search."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...geometry import bernstein_jets

__all__ = ["extents", "point_and_normal"]


@compiled
def point_and_normal(points: Array, normals: Array, u: float, v: float) -> tuple[Array, Array, Array, Array]:
    """Point (3,) and inward unit normal (3,) at (u, v), and their derivatives (3, 2).

    Args:
        points: control points (m, n, 4) of a chart.
        normals: control points (k, l, 3) of its inward m.
        u: parameter.
        v: parameter.
    """
    P, dP = _evaluate(points, u, v)
    M, dM = _evaluate(normals, u, v)
    p, n, dp, dn = np.zeros(3), np.zeros(3), np.zeros((3, 2)), np.zeros((3, 2))
    w = P[3]
    size = np.sqrt(M[0] ** 2 + M[1] ** 2 + M[2] ** 2)
    for a in range(3):
        p[a], n[a] = P[a] / w, M[a] / size
    for k in range(2):
        along = n[0] * dM[0, k] + n[1] * dM[1, k] + n[2] * dM[2, k]
        for a in range(3):
            dp[a, k] = (dP[a, k] - p[a] * dP[3, k]) / w
            dn[a, k] = (dM[a, k] - n[a] * along) / size
    return p, n, dp, dn


@compiled
def extents(points: Array, normals: Array, part: Array) -> Array:
    """How far point and normal move along each side (2,) of a part (4,): the sum, lengths in `UNIT_M`."""
    p, n = np.zeros((2, 2, 3)), np.zeros((2, 2, 3))
    for i in range(2):
        for j in range(2):
            at_p, at_n, _, _ = point_and_normal(points, normals, part[i], part[2 + j])
            p[i, j], n[i, j] = at_p, at_n
    out = np.zeros(2)
    for k in range(2):
        moved, turned = 0.0, 0.0
        for a in range(3):
            if k == 0:
                moved += (p[1, 0, a] - p[0, 0, a]) ** 2 + (p[1, 1, a] - p[0, 1, a]) ** 2
                turned += (n[1, 0, a] - n[0, 0, a]) ** 2 + (n[1, 1, a] - n[0, 1, a]) ** 2
            else:
                moved += (p[0, 1, a] - p[0, 0, a]) ** 2 + (p[1, 1, a] - p[1, 0, a]) ** 2
                turned += (n[0, 1, a] - n[0, 0, a]) ** 2 + (n[1, 1, a] - n[1, 0, a]) ** 2
        out[k] = np.sqrt(moved) + np.sqrt(turned)
    return out


@compiled
def _evaluate(net: Array, u: float, v: float) -> tuple[Array, Array]:
    """Value (c,) and derivatives (c, 2) of a Bernstein form with the control points (m, n, c)."""
    bu, bu1, _ = bernstein_jets(net.shape[0] - 1, u)
    bv, bv1, _ = bernstein_jets(net.shape[1] - 1, v)
    width = net.shape[2]
    value, slopes = np.zeros(width), np.zeros((width, 2))
    for i in range(net.shape[0]):
        for j in range(net.shape[1]):
            for c in range(width):
                value[c] += bu[i] * bv[j] * net[i, j, c]
                slopes[c, 0] += bu1[i] * bv[j] * net[i, j, c]
                slopes[c, 1] += bu[i] * bv1[j] * net[i, j, c]
    return value, slopes
