"""Faults of meshes: repeated corners and triangles, walls inside, shared edges and holes."""

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...base.text.plain_text import counted
from .corners_on_edges import split_at_corners
from .manifold import from_manifold, to_manifold
from .weld import weld

__all__ = ["find_fault", "repair", "separate_bodies"]

# Corners that an exporter wrote apart by rounding lie so near, as a share of the mesh's size.
_GAP = 1e-5
# A hole wider than this share of the size is filled too, but what was there is a guess, and that is said.
_SMALL_HOLE = 0.05
_MOST_SHEETS = 16
# With more open edges to a triangle these are scraps, each a hole of its own, and no surface with holes.
_TORN = 1.2


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
    if len(mesh.faces) and not _is_closed(mesh) and (moved := _join_corners(mesh)):
        reach_mm = 1e3 * _GAP * float(mesh.scale)
        done.append(f"joined {moved} corners that nearly met (within {reach_mm:.2g} mm)")
    if len(mesh.faces) and not _is_closed(mesh) and (split := _split_at_corners(mesh)):
        done.append(f"split {counted(split, 'triangle')} at corners that lay on their edges")
    if len(mesh.faces) and not _is_closed(mesh) and (walls := _drop_walls(mesh)):
        done.append(f"left out {walls} triangles of walls inside")
    if len(mesh.faces) and not _is_closed(mesh) and (widths := _fill_holes(mesh)):
        share = max(widths) / float(mesh.scale)
        guess = f", {share:.0%} of its size: a guess" if share > _SMALL_HOLE else ""
        done.append(f"closed {counted(len(widths), 'hole')} of up to {1e3 * max(widths):.2g} mm{guess}")
    return done


def find_fault(mesh: trimesh.Trimesh, *, is_final: bool = False) -> str:
    """Why a mesh bounds no solid and where, in words; empty where every edge has faces in pairs.

    Args:
        mesh: triangles.
        is_final: bodies are apart, so that more than one pair at an edge is a fault.
    """
    if len(mesh.faces) == 0:
        return "all of its triangles are lines or stand twice"
    edges, counts = _edge_counts(mesh)
    odd = counts % 2 == 1
    if not odd.any():
        many = counts > 2
        if not is_final or not many.any():
            return ""
        odd = many
    worst = np.flatnonzero(odd)[np.argmin(counts[odd])]
    place = ", ".join(f"{x:.4g}" for x in mesh.vertices[edges[worst]].mean(axis=0))
    if counts[worst] == 1:
        return f"{int(np.sum(counts == 1))} open edges that bound no hole to fill, one at ({place}) m"
    return f"{counts[worst]} triangles meet at one edge at ({place}) m"


def separate_bodies(mesh: trimesh.Trimesh) -> None:
    """Gives bodies that share edges or corners alone vertices of their own, in place."""
    if mesh.is_watertight:
        return
    faces = np.array(mesh.faces)
    label = _sheets(mesh)
    corner, index = np.unique(
        np.column_stack([faces.ravel(), np.repeat(label, 3)]), axis=0, return_inverse=True
    )
    split = trimesh.Trimesh(mesh.vertices[corner[:, 0]], index.reshape(-1, 3), process=False)
    if not split.is_watertight:
        # Parts that also hang together elsewhere: where windings agree, manifold3d finds faces that belong.
        solid = to_manifold(mesh)
        split = mesh if solid is None else from_manifold(solid)
    mesh.vertices = np.array(split.vertices)
    mesh.faces = np.array(split.faces)


def _sheets(mesh: trimesh.Trimesh) -> NDArray[np.int64]:
    """For each triangle the sheet (n,) that it is of: triangles joined over edges that only two have."""
    pairs, n = mesh.face_adjacency, len(mesh.faces)
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _edge_counts(mesh: trimesh.Trimesh) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Edges (n, 2) and how many triangles (n,) have each."""
    keys, counts = np.unique(_edge_keys(mesh.faces), return_counts=True)
    low, high = np.divmod(keys, _key_step(mesh.faces))
    return np.column_stack([low, high]), counts


def _edge_keys(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """A number for each edge (3 n,) of triangles (n, 3), the same both ways; pairs take longer to sort."""
    ends = np.asarray(faces)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys: NDArray[np.int64] = ends.min(axis=1) * _key_step(faces) + ends.max(axis=1)
    return keys


def _key_step(faces: NDArray[np.int64]) -> int:
    return int(faces.max()) + 1


def _is_closed(mesh: trimesh.Trimesh) -> bool:
    return _odd_edges(mesh.faces) == 0


def _odd_edges(faces: NDArray[np.int64]) -> int:
    """How many edges have an odd number of triangles (n, 3)."""
    return int(np.sum(np.unique(_edge_keys(faces), return_counts=True)[1] % 2))


def _drop_lines(mesh: trimesh.Trimesh) -> None:
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()


def _drop_repeated(mesh: trimesh.Trimesh) -> int:
    """Triangles on the same three corners, either way round, are one."""
    before = len(mesh.faces)
    corners = np.sort(mesh.faces, axis=1)
    _, first, inverse, counts = np.unique(
        corners, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    if len(first) == before:
        return 0
    # A wall between two bodies stands twice and goes; a surface that stands twice stays once. Whichever it is
    # leaves fewer edges open.
    kept = [counts[inverse.ravel()] % 2 == 1, np.isin(np.arange(before), first)]
    kept[0] &= kept[1]
    open_edges = [_odd_edges(mesh.faces[chosen]) if chosen.any() else np.inf for chosen in kept]
    mesh.update_faces(kept[int(np.argmin(open_edges))])
    mesh.remove_unreferenced_vertices()
    return before - len(mesh.faces)


def _drop_walls(mesh: trimesh.Trimesh) -> int:
    """Leaves out walls and fins: sheets that hang on a surface which does without them."""
    before = len(mesh.faces)
    while (wall := _find_wall(mesh)) is not None:
        mesh.update_faces(~wall)
        mesh.remove_unreferenced_vertices()
    return before - len(mesh.faces)


def _find_wall(mesh: trimesh.Trimesh) -> NDArray[np.bool_] | None:
    """The triangles (n,) of a sheet without which no edge of its border is odd; None where there is none."""
    _, of_edge, counts = np.unique(_edge_keys(mesh.faces), return_inverse=True, return_counts=True)
    if not np.any(counts == 3):
        return None
    of_face = of_edge.reshape(-1, 3)
    label = _sheets(mesh)
    areas = np.bincount(label, weights=mesh.area_faces)
    # The outside of a body with one wall is two sheets, so that the wall is the smallest as a rule.
    for sheet in np.argsort(areas)[:_MOST_SHEETS]:
        wall = label == sheet
        edges, own = np.unique(of_face[wall], return_counts=True)
        border = counts[edges] != 2
        hangs = np.all(counts[edges][border] % 2 == 1) and np.all(own[border] % 2 == 1)
        if not hangs or not np.any(counts[edges] == 3) or wall.all():
            continue
        corners = mesh.vertices[mesh.faces[~wall]].reshape(-1, 3)
        rest = np.array([corners.min(axis=0), corners.max(axis=0)])
        if np.allclose(rest, mesh.bounds, rtol=0, atol=1e-9):
            return np.asarray(wall)
    return None


def _join_corners(mesh: trimesh.Trimesh) -> int:
    before = len(mesh.vertices)
    vertices, index = weld(np.array(mesh.vertices), _GAP * float(mesh.scale))
    faces = index[mesh.faces]
    mesh.vertices = vertices
    mesh.faces = faces
    _drop_lines(mesh)
    return before - len(vertices)


def _split_at_corners(mesh: trimesh.Trimesh) -> int:
    """How many triangles were split; none, and nothing done, where as many edges stay open."""
    before, faces = _odd_edges(mesh.faces), np.array(mesh.faces)
    split = split_at_corners(mesh, _GAP * float(mesh.scale))
    if split and _odd_edges(mesh.faces) >= before:
        mesh.faces = faces
        return 0
    return split


def _fill_holes(mesh: trimesh.Trimesh) -> list[float]:
    """Closes holes by triangles to their middle; returns their widths in m."""
    loops = _boundary_loops(mesh)
    widths = [float(np.linalg.norm(np.ptp(mesh.vertices[loop], axis=0))) for loop in loops]
    if not loops or sum(map(len, loops)) > _TORN * len(mesh.faces):
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
    unique, counts = _edge_counts(mesh)
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
