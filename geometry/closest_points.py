"""The nearest points of triangles, however small these are.

The library's own function takes numbers below 1e-13 for nothing, among them squares of areas: of triangles
below a third of a square millimetre, in m, it finds points on their edges, up to their length away.
"""

import numpy as np
import trimesh

from ..base.numeric.arrays import Array

__all__ = ["closest_on_triangles"]

# Triangles are this large where they are looked at.
_LARGE = 1e6


def closest_on_triangles(triangles: Array, points: Array) -> Array:
    """The point (n, 3) of each triangle (n, 3, 3) that is nearest to its point (n, 3); any units."""
    away = triangles - points[:, None]
    size = np.ptp(triangles, axis=1).max(axis=1)
    scale = np.where(size > 0.0, _LARGE / np.where(size > 0.0, size, 1.0), 1.0)
    nearest = trimesh.triangles.closest_point(  # type: ignore[no-untyped-call]
        away * scale[:, None, None], np.zeros_like(points)
    )
    return points + np.asarray(nearest) / scale[:, None]
