"""The surface of a body made of convex shapes: how far points lie off it, and which way it faces there."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices, Mask
from .closest_points import closest_on_triangles
from .shapes import Capsule, Shape, Sphere, shape_mesh

__all__ = ["ConvexSurface"]

# Shapes and faces that are this near to being the nearest ones all count as nearest, as at an edge or a seam.
_SAME_M = 1e-5
# A point in the plane of several faces may seem to be above one of them and below the next.
_ROUNDING_M = 1e-9


class ConvexSurface:
    """The surface of the union of convex shapes, in their frame.

    Inside the union the shape in which a point lies deepest counts: the depth is never overstated.
    """

    def __init__(self, shapes: Iterable[Shape]):
        self._shapes = [_round(shape) or _faceted(shape) for shape in shapes]

    def signed_distances(self, points: Array) -> Array:
        """Distances (n,) in m of points (n, 3), negative inside; inf where there are no shapes."""
        return self._compare(points, np.zeros_like(points))[0]

    def compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        """Points (n, 3) with unit normals (n, 3) against the surface.

        Returns:
            Distances (n,) in m from the surface, not signed, and the angles (n,) in rad between the normals
            and the outward normals at the nearest places; at edges that of the face which agrees best.
        """
        distance, cosine = self._compare(points, normals)
        return np.abs(distance), np.arccos(np.clip(cosine, -1.0, 1.0))

    def _compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        if not self._shapes:
            return np.full(len(points), np.inf), np.ones(len(points))
        found = [shape.compare(points, normals) for shape in self._shapes]
        distances, cosines = np.array([entry[0] for entry in found]), np.array([entry[1] for entry in found])
        least = distances.min(axis=0)
        return least, np.where(distances <= least + _SAME_M, cosines, -1.0).max(axis=0)


@dataclass(frozen=True, eq=False)
class _Round:
    """All points within `radius` of the segment from `start` along `axis`, which may be zero."""

    start: Array
    axis: Array
    radius: float

    def compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        """Signed distances (n,) and cosines (n,) between normals and outward normals."""
        length2 = float(self.axis @ self.axis)
        along = np.clip((points - self.start) @ self.axis / length2, 0.0, 1.0) if length2 else 0.0
        outward = points - self.start - np.multiply.outer(along, self.axis)
        lengths = np.linalg.norm(outward, axis=1)
        cosine = np.einsum("ij,ij->i", outward, normals) / np.maximum(lengths, 1e-300)
        return lengths - self.radius, cosine


@dataclass(frozen=True, eq=False)
class _Faceted:
    """A convex polyhedron by its triangles (m, 3, 3), their unit outward normals (m, 3) and offsets (m,)."""

    triangles: Array
    outward: Array
    offsets: Array

    def compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        """Signed distances (n,) and cosines (n,) between normals and outward normals."""
        heights = points @ self.outward.T - self.offsets
        distance = heights.max(axis=1)
        is_nearest = heights >= distance[:, None] - _SAME_M
        outside = np.flatnonzero(distance > 0.0)
        if len(outside):
            distance[outside], is_nearest[outside] = self._nearest(
                points[outside], heights[outside] > -_ROUNDING_M
            )
        cosine = np.where(is_nearest, normals @ self.outward.T, -1.0).max(axis=1)
        return distance, cosine

    def _nearest(self, points: Array, is_seen: Mask) -> tuple[Array, Mask]:
        """Distances (k,) of points outside, and which faces (k, m) are nearest, of those that they see."""
        which, face = (np.asarray(index, dtype=np.int64) for index in np.nonzero(is_seen))
        lengths = np.full(is_seen.shape, np.inf)
        lengths[which, face] = _to_triangles(points[which], self.triangles[face])
        distance = lengths.min(axis=1)
        return distance, lengths <= distance[:, None] + _SAME_M


def _to_triangles(points: Array, triangles: Array) -> Array:
    """Distance (n,) of each point (n, 3) from its triangle (n, 3, 3)."""
    return np.asarray(np.linalg.norm(closest_on_triangles(triangles, points) - points, axis=1))


def _round(shape: Shape) -> _Round | None:
    match shape:
        case Sphere():
            return _Round(shape.centre, np.zeros(3), shape.radius)
        case Capsule():
            return _Round(shape.start, shape.end - shape.start, shape.radius)
    return None


def _faceted(shape: Shape) -> _Faceted:
    mesh = shape_mesh(shape)
    faces: Indices = np.asarray(mesh.faces)
    triangles = np.asarray(mesh.vertices)[faces]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    triangles, normals = triangles[lengths > 0.0], normals[lengths > 0.0] / lengths[lengths > 0.0, None]
    return _Faceted(triangles, normals, np.einsum("ij,ij->i", normals, triangles[:, 0]))
