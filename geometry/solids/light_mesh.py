"""Meshes with fewer triangles, to be looked at."""

import numpy as np
import trimesh

__all__ = ["light_mesh"]

# Cells along the longest side at first, and by what factor they grow while too many triangles are left.
_CELLS, _COARSER = 256.0, 0.75


def light_mesh(mesh: trimesh.Trimesh, most: int) -> trimesh.Trimesh:
    """The mesh itself, or one like it with `most` triangles at most.

    Vertices in one cell of a grid become one, their mean, and triangles that lose a side fall away. So what
    is left is near to the surface, to within a cell, but not always closed.
    """
    cells = _CELLS
    light = mesh
    while len(light.faces) > most:
        light = _clustered(mesh, float(np.ptp(mesh.bounds, axis=0).max()) / cells)
        cells *= _COARSER
    return light


def _clustered(mesh: trimesh.Trimesh, cell_m: float) -> trimesh.Trimesh:
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    keys = np.floor((vertices - vertices.min(axis=0)) / cell_m).astype(np.int64)
    _, cluster, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    cluster = cluster.reshape(-1)
    means = np.stack([np.bincount(cluster, axis) for axis in vertices.T], axis=1) / count[:, None]
    corners = cluster[faces]
    a, b, c = corners.T
    whole = corners[(a != b) & (b != c) & (c != a)]
    # Where a thin wall has collapsed, the same triangle is left once from each side.
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    return trimesh.Trimesh(means, whole[np.sort(first)], process=False)
