"""Closed surfaces as solids of manifold3d, which unites, subtracts and checks them, and back."""

import manifold3d
import numpy as np
import trimesh

from ..shapes import Hull

__all__ = ["from_hull", "from_manifold", "to_manifold"]


def to_manifold(mesh: trimesh.Trimesh) -> manifold3d.Manifold | None:
    """The solid that a closed surface bounds, None where it bounds none (open, or more faces at an edge)."""
    solid = manifold3d.Manifold(
        manifold3d.Mesh64(
            np.ascontiguousarray(mesh.vertices, dtype=np.float64),
            np.ascontiguousarray(mesh.faces, dtype=np.uint64),
        )
    )
    return None if solid.status() != manifold3d.Error.NoError or solid.is_empty() else solid


def from_hull(hull: Hull) -> manifold3d.Manifold:
    """A convex piece as a solid."""
    return manifold3d.Manifold.hull_points(np.ascontiguousarray(hull.vertices))


def from_manifold(solid: manifold3d.Manifold) -> trimesh.Trimesh:
    """The surface of a solid, outward normals."""
    data = solid.to_mesh64()
    vertices = np.array(data.vert_properties, dtype=float)[:, :3]
    return trimesh.Trimesh(vertices, np.array(data.tri_verts, dtype=np.int64), process=False)
