"""Oracles of the tests: distances to a mesh and to convex pieces, by other means than the code's own."""

import numpy as np
import trimesh
from scipy.spatial import ConvexHull


def distance_to_mesh(mesh, points):
    """Distance (n,) to the nearest triangle, by trimesh's own closest point on each."""
    triangles = mesh.triangles[mesh.area_faces > 0]
    out = []
    for p in points:
        nearest = trimesh.triangles.closest_point(triangles, np.tile(p, (len(triangles), 1)))
        out.append(np.linalg.norm(nearest - p, axis=1).min())
    return np.array(out)


def plane_distances(piece, points):
    """Signed distances (n, faces) of points to the planes of a hull's faces, by Qhull; negative inside."""
    equations = ConvexHull(piece.vertices).equations
    return points @ equations[:, :3].T + equations[:, 3]


def height_above(pieces, points):
    """How far points (n, 3) lie above the union of convex pieces, at least; negative is depth in one."""
    return np.min([plane_distances(piece, points).max(axis=1) for piece in pieces], axis=0)


def facet_below(mesh, point):
    """Index of the triangle nearest to a point."""
    triangles = mesh.triangles
    nearest = trimesh.triangles.closest_point(triangles, np.tile(point, (len(triangles), 1)))
    distance = np.linalg.norm(nearest - point, axis=1)
    distance[mesh.area_faces == 0] = np.inf
    return int(np.argmin(distance))


def is_closed(mesh):
    return mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0
