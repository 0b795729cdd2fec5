"""The corner of a convex hull that lies furthest along a direction, found by going uphill along its edges.

On a convex body a corner from which no edge goes up is the furthest one. So some tens of corners are looked
at where a hull has hundreds or thousands. That a hull's triangles make a convex body is checked edge by edge;
points of which that is not known are all looked at.
"""

from typing import NamedTuple

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices
from .shapes import Hull

__all__ = ["Corners", "any_corners", "furthest", "hull_edges"]

# A triangle may rise so far above its neighbour's plane; rounding makes some 1e-14.
_BENT_M = 1e-12


class Corners(NamedTuple):
    """Points whose convex hull is meant.

    Attributes:
        points: (n, 3) in m.
        firsts: (n + 1,) where each point's neighbours begin in `neighbours`, and the last one's end; all the
            same where no edges are known.
        neighbours: points at the other ends of edges.
    """

    points: Array
    firsts: Indices
    neighbours: Indices


def any_corners(points: Array) -> Corners:
    """Points (n, 3) of whose hull nothing is known, in the one layout that the code below is compiled for."""
    count = len(points)
    plain = np.array(points, dtype=float, order="C")
    return Corners(plain, np.zeros(count + 1, dtype=np.int64), np.zeros(0, dtype=np.int64))


def hull_edges(hull: Hull) -> tuple[Indices, Indices]:
    """How many neighbours (n,) each vertex has, and these in order; none where it may not be convex."""
    faces, vertices = hull.faces, hull.vertices
    count = len(vertices)
    # Each side of a triangle as from one corner to the next, with the corner across.
    start, end, across = (np.concatenate([faces[:, (k + i) % 3] for i in range(3)]) for k in range(3))
    sides, back = start * count + end, end * count + start
    order = np.argsort(sides)
    there = order[np.minimum(np.searchsorted(sides[order], back), len(sides) - 1)]
    is_closed = len(np.unique(sides)) == len(sides) and np.array_equal(sides[there], back)
    is_whole = len(np.unique(start)) == count
    if not (is_closed and is_whole and _rises_m(vertices, faces, across[there]) <= _BENT_M):
        return np.zeros(count, dtype=np.int64), np.zeros(0, dtype=np.int64)
    # Closed, a vertex has as many sides that begin there as neighbours.
    by_start = np.argsort(start, kind="stable")
    return np.bincount(start, minlength=count), np.asarray(end[by_start], dtype=np.int64)


def _rises_m(vertices: Array, faces: Indices, beyond: Indices) -> float:
    """How far the corners (3 m,) across the sides of triangles (m, 3) rise above these; inf for slivers."""
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(q - p, r - p)
    areas = np.linalg.norm(normals, axis=1)
    if areas.min() == 0.0:
        return np.inf
    normals /= areas[:, None]
    to = vertices[beyond] - np.tile(p, (3, 1))
    return float((to * np.tile(normals, (3, 1))).sum(axis=1).max())


@compiled
def furthest(corners: Corners, direction: tuple[float, float, float], at: int) -> int:
    """The point furthest along a direction, looked for from the point `at` on; of equals, any."""
    points, firsts = corners.points, corners.firsts
    x, y, z = direction
    if firsts[0] == firsts[len(points)]:
        at = 0
        most = -np.inf
        for i in range(len(points)):
            along = points[i, 0] * x + points[i, 1] * y + points[i, 2] * z
            if along > most:
                most, at = along, i
        return at
    most = points[at, 0] * x + points[at, 1] * y + points[at, 2] * z
    while True:
        here = at
        for k in range(firsts[here], firsts[here + 1]):
            i = corners.neighbours[k]
            along = points[i, 0] * x + points[i, 1] * y + points[i, 2] * z
            if along > most:
                most, at = along, i
        if at == here:
            return at
