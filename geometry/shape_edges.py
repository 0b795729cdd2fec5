"""How far a body made of convex shapes goes on beside a place on its surface."""

from collections.abc import Iterable
from functools import lru_cache
from math import inf

import numpy as np

from ..base.numeric.arrays import Array
from .shapes import Hull, Shape, shape_mesh

__all__ = ["length_below_surface"]

# A side that a way comes no nearer to, to rounding, never ends it.
_AHEAD = 1e-12


def length_below_surface(
    shapes: Iterable[Shape], place: Array, outwards: Array, along: Array, depth_m: float
) -> float:
    """How far it is along a direction from below a place to where the body ends.

    Args:
        shapes: of the body, in its frame; where several are there, the one that goes on farthest counts.
        place: on the surface (3,), in m; what it lies off the nearest shape is made up for.
        outwards: unit normal (3,) there.
        along: unit vector (3,) in the tangent plane.
        depth_m: how far below the surface to go.

    Returns:
        The length in m; infinite where no shape is there.
    """
    sides = [_planes(shape) for shape in shapes]
    heights_m = [float((normals @ place - offsets).max()) for normals, offsets in sides]
    below = place - (depth_m + max(0.0, min(heights_m, default=0.0))) * outwards
    lengths = [0.0]
    for normals, offsets in sides:
        rooms, speeds = offsets - normals @ below, normals @ along
        ahead = speeds > _AHEAD
        if rooms.min() >= 0.0:  # else it is beside this shape
            lengths.append(float((rooms[ahead] / speeds[ahead]).min(initial=inf)))
    return max(lengths) or inf


@lru_cache(maxsize=256)
def _planes(shape: Shape) -> tuple[Array, Array]:
    """Normals (k, 3) and offsets (k,) of the sides of a shape, of round ones about."""
    hull = shape if isinstance(shape, Hull) else Hull.from_points(np.array(shape_mesh(shape).vertices))
    return hull.planes
