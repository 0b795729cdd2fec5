"""Corners that lie on edges of other triangles, as CAD programs leave them: such edges seem open.

A long edge of one face runs along several short ones of the faces beside it. Split where those meet, it has a
partner for each of its parts, and nothing of the shape changes.
"""

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ...base.numeric.arrays import Array

__all__ = ["split_at_corners"]

# Triangles may have corners on each of their edges, and what is split once may have others.
_MOST_ROUNDS = 6


def split_at_corners(mesh: trimesh.Trimesh, reach_m: float) -> int:
    """Splits triangles at corners of open edges that lie on their own open ones, in place; returns how many.

    Args:
        mesh: triangles, equal corners merged.
        reach_m: how far a corner may lie off an edge.
    """
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces)
    split = 0
    for _ in range(_MOST_ROUNDS):
        faces, count = _split_once(vertices, faces, reach_m)
        split += count
        if not count:
            break
    if split:
        mesh.faces = faces
    return split


def _split_once(vertices: Array, faces: NDArray[np.int64], reach_m: float) -> tuple[NDArray[np.int64], int]:
    """Triangles (m, 3) in which each that has corners on an open edge is split along one such edge."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, index, counts = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    is_open = np.flatnonzero(counts[index.ravel()] == 1)
    corners = np.unique(edges[is_open])
    if not len(is_open):
        return faces, 0
    a, b = vertices[edges[is_open, 0]], vertices[edges[is_open, 1]]
    lengths = np.linalg.norm(b - a, axis=1)
    near = KDTree(vertices[corners]).query_ball_point(0.5 * (a + b), 0.5 * lengths + reach_m)
    parts: dict[int, list[list[int]]] = {}
    for k, edge in enumerate(is_open):
        face, first = divmod(int(edge), 3)
        if face in parts or lengths[k] <= reach_m:
            continue
        on = _between(vertices, corners[near[k]], edges[edge], (a[k], (b[k] - a[k]) / lengths[k]), reach_m)
        if on:
            row = [int(edges[edge, 0]), *on, int(edges[edge, 1])]
            apex = int(faces[face, (first + 2) % 3])
            parts[face] = [[row[i], row[i + 1], apex] for i in range(len(row) - 1)]
    if not parts:
        return faces, 0
    kept = np.delete(faces, list(parts), axis=0)
    return np.vstack([kept, *parts.values()]), len(parts)


def _between(
    vertices: Array,
    near: NDArray[np.int64],
    ends: NDArray[np.int64],
    line: tuple[Array, Array],
    reach_m: float,
) -> list[int]:
    """Of some corners those that lie on an edge between its ends, in order.

    Args:
        vertices: (n, 3).
        near: numbers of the corners.
        ends: (2,) numbers of the edge's own.
        line: (3,) where the edge begins, and (3,) the unit vector along it.
        reach_m: how far they may lie off it.
    """
    near = near[~np.isin(near, ends)]
    origin, along = line
    away = vertices[near] - origin
    at = away @ along
    off = np.linalg.norm(away - at[:, None] * along, axis=1)
    length = float(np.linalg.norm(vertices[ends[1]] - origin))
    on = (off <= reach_m) & (at > reach_m) & (at < length - reach_m)
    return [int(k) for k in near[on][np.argsort(at[on])]]
