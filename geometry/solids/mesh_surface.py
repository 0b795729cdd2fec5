"""The surface of a mesh: how far points lie off it, and which way it faces there."""

import numpy as np
import trimesh

from ...base.numeric.arrays import Array, Indices
from ..closest_points import closest_on_triangles

__all__ = ["MeshSurface"]

# Faces within this distance of a point are looked at first, then those within four times as much, and so on.
_FIRST_REACH_M = 1e-3
# Faces that are this much farther than the nearest one count as nearest too, as at an edge.
_SAME_M = 1e-6


class MeshSurface:
    """The surface of a closed mesh with outward normals, in m."""

    def __init__(self, mesh: trimesh.Trimesh):
        self._triangles = np.asarray(mesh.triangles)
        self._outward = np.asarray(mesh.face_normals)
        self._low, self._high = self._triangles.min(axis=1), self._triangles.max(axis=1)

    def compare(self, points: Array, normals: Array) -> tuple[Array, Array]:
        """Points (n, 3) with unit normals (n, 3) against the surface.

        Returns:
            Distances (n,) in m from the surface, not signed, and the angles (n,) in rad between the normals
            and the outward normals at the nearest places; at edges that of the face which agrees best.
        """
        reach_m = _FIRST_REACH_M
        faces, lengths = self._within(reach_m, points)
        while np.any(lengths.min(axis=1, initial=np.inf) > reach_m):
            reach_m *= 4.0
            faces, lengths = self._within(reach_m, points)
        distance = lengths.min(axis=1)
        cosines = np.where(lengths <= distance[:, None] + _SAME_M, normals @ self._outward[faces].T, -1.0)
        return distance, np.arccos(np.clip(cosines.max(axis=1), -1.0, 1.0))

    def _within(self, reach_m: float, points: Array) -> tuple[Indices, Array]:
        """Faces (k,) near the points, and their distances (n, k); inf for some that are farther than that."""
        low, high = points.min(axis=0) - reach_m, points.max(axis=0) + reach_m
        faces = np.flatnonzero(np.all((self._low <= high) & (self._high >= low), axis=1))
        is_near = np.all(
            (self._low[faces] <= points[:, None] + reach_m)
            & (self._high[faces] >= points[:, None] - reach_m),
            axis=2,
        )
        which, k = np.nonzero(is_near)
        nearest = closest_on_triangles(self._triangles[faces[k]], points[which])
        lengths = np.full(is_near.shape, np.inf)
        lengths[which, k] = np.linalg.norm(nearest - points[which], axis=1)
        return faces, lengths
