"""The cone of a soft finger as edges: what friction lets one contact do, at unit normal force."""

from functools import cache

import numpy as np
import trimesh
from scipy.spatial import ConvexHull

from ..base.numeric.arrays import Array

__all__ = ["cone_edges", "even_directions"]


def cone_edges(mu: float, mu_t: float, subdivisions: int, *, outside: bool = False) -> Array:
    """Edges (4, k) of a soft-finger cone at unit normal force.

    Their hull lies in the cone or, with `outside`, the cone in it.
    """
    directions = even_directions(subdivisions)
    if outside:  # the facet nearest to the middle then touches the unit ball
        directions = directions / _nearest_facet(subdivisions)
    return np.vstack([np.ones(len(directions)), np.diag([mu, mu, mu_t]) @ directions.T])


@cache
def even_directions(subdivisions: int) -> Array:
    """Unit vectors (k, 3) spread over the sphere: 12, 42 or 162 of them with 0, 1 or 2 subdivisions."""
    directions = np.array(trimesh.creation.icosphere(subdivisions=subdivisions).vertices)
    directions.setflags(write=False)
    return directions


@cache
def _nearest_facet(subdivisions: int) -> float:
    """How far the hull of such directions reaches at least."""
    return float(-ConvexHull(even_directions(subdivisions)).equations[:, -1].max())
