"""The convex hull of a net of control points: its facets that face down (paper, section 4.3, figure 5c).

The points lie over a grid, so a facet is a triangle of them with all others on one side. Vertical facets say
no more than the sides of the box do. The arithmetic is plain: any slopes give a valid inequality, once its
constant is taken over all control points in outward rounding.
"""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices

__all__ = ["count_triangles", "lower_facets"]

# Shares of a net's height: points so little below a plane lie on it, and rises that differ so little are one.
_FLAT = 1e-9
# Where a triangle is looked through, in weights of its corners: generic, for no side of another passes there.
_GENERIC = 0.3183, 0.3517


@compiled
def count_triangles(di: int, dj: int) -> int:
    """Halves of the cells of the grid of a net of degrees (di, dj): one side of a hull has no more facets."""
    return 2 * di * dj


@compiled
def lower_facets(z: Array, di: int, dj: int, rises: Array) -> None:
    """Finds the lower facets of a net; those of its negative are the upper ones.

    Args:
        z: ((di + 1)(dj + 1),) heights of the points, row by row, with both degrees at least 1.
        di: degree along the first parameter.
        dj: degree along the second.
        rises: (count_triangles, 2) filled with the rise of the facet below each half of a cell, by a step
            along the first parameter and along the second; NaN where an earlier half has the same facet.
    """
    w = dj + 1
    flat = _FLAT * (z.max() - z.min()) + 1e-300
    corners = np.empty(3, dtype=np.int64)
    for t in range(count_triangles(di, dj)):
        p, q = t // 2 // dj, t // 2 % dj
        corners[1], corners[2] = (p + 1) * w + q, p * w + q + 1
        if t % 2 == 0:
            corners[0] = p * w + q
            rise_i, rise_j = _facet_below(z, w, p + _GENERIC[0], q + _GENERIC[1], corners, flat)
        else:
            corners[0] = (p + 1) * w + q + 1
            rise_i, rise_j = _facet_below(z, w, p + 1 - _GENERIC[0], q + 1 - _GENERIC[1], corners, flat)
        for s in range(t):
            if abs(rises[s, 0] - rise_i) * di + abs(rises[s, 1] - rise_j) * dj <= flat:
                rise_i, rise_j = np.nan, np.nan
                break
        rises[t, 0], rises[t, 1] = rise_i, rise_j


@compiled
def _facet_below(z: Array, w: int, a: float, b: float, corners: Indices, flat: float) -> tuple[float, float]:
    """Rises of the lower facet at the place (a, b) of the grid, from the corners (3,) of a triangle there.

    The simplex method: as long as some point lies below the plane, the lowest such stands in for the corner
    without which the triangle still holds the place. So the plane sinks there with every step.
    """
    rise_i, rise_j = 0.0, 0.0
    for _ in range(4 * len(z)):
        o, u, v = corners
        ui, uj, vi, vj = u // w - o // w, u % w - o % w, v // w - o // w, v % w - o % w
        det = float(ui * vj - uj * vi)
        rise_i = ((z[u] - z[o]) * vj - (z[v] - z[o]) * uj) / det
        rise_j = ((z[v] - z[o]) * ui - (z[u] - z[o]) * vi) / det
        lowest, depth = -1, flat
        for k in range(len(z)):
            below = z[o] + rise_i * (k // w - o // w) + rise_j * (k % w - o % w) - z[k]
            if below > depth:
                lowest, depth = k, below
        if lowest < 0:
            break
        # Weights of the corners for the place, and for the new point.
        ai, aj, ki, kj = a - o // w, b - o % w, lowest // w - o // w, lowest % w - o % w
        place_u, place_v = (ai * vj - aj * vi) / det, (aj * ui - ai * uj) / det
        point_u, point_v = (ki * vj - kj * vi) / det, (kj * ui - ki * uj) / det
        leaving, share = 0, np.inf
        for c, place, point in (
            (0, 1.0 - place_u - place_v, 1.0 - point_u - point_v),
            (1, place_u, point_u),
            (2, place_v, point_v),
        ):
            if point > 1e-12 and place / point < share:
                leaving, share = c, place / point
        corners[leaving] = lowest
    return rise_i, rise_j
