"""Small faults of meshes: repeated corners and triangles, and small holes."""

import numpy as np
import trimesh
from numpy.typing import NDArray

from .weld import weld

__all__ = ["LARGEST_HOLE", "repair"]

LARGEST_HOLE = 0.05
"""Width of the largest hole that is closed, as a share of the mesh's size."""

# Corners that an exporter wrote apart by rounding lie so near, as a share of the mesh's size.
_GAP = 1e-5


def repair(mesh: trimesh.Trimesh) -> list[str]:
    """Closes what is open by a small fault, in place; says what it did beyond merging equal corners.

    A mesh that is closed once equal corners are one is left alone.
    """
    # Formats that repeat a vertex for each of its faces or texture seams would leave every edge open.
    mesh.merge_vertices()
    _drop_lines(mesh)
    if len(mesh.faces) == 0 or mesh.is_watertight:
        return []
    done = []
    if dropped := _drop_repeated(mesh):
        done.append(f"left out {dropped} triangles that stood twice")
    if len(mesh.faces) and not mesh.is_watertight and (moved := _join_corners(mesh)):
        done.append(f"joined {moved} corners that nearly met")
    if len(mesh.faces) and not mesh.is_watertight and (widths := _fill_holes(mesh)):
        done.append(f"closed {len(widths)} holes of up to {1e3 * max(widths):.2g} mm")
    return done


def _drop_lines(mesh: trimesh.Trimesh) -> None:
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()


def _drop_repeated(mesh: trimesh.Trimesh) -> int:
    """Triangles on the same three corners, either way round, are one."""
    before = len(mesh.faces)
    mesh.update_faces(mesh.unique_faces())
    return before - len(mesh.faces)


def _join_corners(mesh: trimesh.Trimesh) -> int:
    before = len(mesh.vertices)
    vertices, index = weld(np.array(mesh.vertices), _GAP * float(mesh.scale))
    faces = index[mesh.faces]
    mesh.vertices = vertices
    mesh.faces = faces
    _drop_lines(mesh)
    return before - len(vertices)


def _fill_holes(mesh: trimesh.Trimesh) -> list[float]:
    """Closes holes by triangles to their middle; returns their widths in m, none if one is too large."""
    loops = _boundary_loops(mesh)
    widths = [float(np.linalg.norm(np.ptp(mesh.vertices[loop], axis=0))) for loop in loops]
    if not loops or max(widths) > LARGEST_HOLE * float(mesh.scale):
        return []
    vertices, faces = [np.array(mesh.vertices)], [np.array(mesh.faces)]
    count = len(mesh.vertices)
    for k, loop in enumerate(loops):
        vertices.append(mesh.vertices[loop].mean(axis=0)[None, :])
        faces.append(np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), count + k)]))
    mesh.vertices = np.vstack(vertices)
    mesh.faces = np.vstack(faces)
    return widths


def _boundary_loops(mesh: trimesh.Trimesh) -> list[NDArray[np.int64]]:
    """Closed rows of corners around holes; none where more than two open edges meet in a corner."""
    edges = np.sort(mesh.edges, axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    beside: dict[int, list[int]] = {}
    for a, b in unique[counts == 1].tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    if any(len(others) != 2 for others in beside.values()):
        return []
    loops = []
    while beside:
        loop = [next(iter(beside))]
        while others := beside.pop(loop[-1], None):
            following = [other for other in others if other in beside]
            if following:
                loop.append(following[0])
        loops.append(np.array(loop, dtype=np.int64))
    return loops
