"""A closed mesh from Bezier surfaces whose edges meet."""

from math import ceil, sqrt

import numpy as np
import trimesh
from numpy.typing import NDArray

from ...errors import InputError
from ..bezier import BezierPatch
from .weld import weld

__all__ = ["join_patches"]


# Edges typed with six decimals of a metre meet to this.
_DEFAULT_GAP_M = 2e-6
# Chords of the mesh leave the surface by at most this share of its size.
_CHORD = 2e-4
_FEWEST, _MOST = 4, 48


def join_patches(
    surfaces: dict[str, BezierPatch], gap_m: float | None, source: str, field: str
) -> trimesh.Trimesh:
    """The closed mesh of surfaces that share their edges, corner to corner.

    Args:
        surfaces: by name, outward normals p_u x p_v; edges that meet have the same curve.
        gap_m: how far edges that meet may be apart; 2 um where it is None.
        source: the file that describes them, for error messages.
        field: where in that file.

    Raises:
        InputError: an edge without a neighbour, a surface that looks inwards, or no volume.
    """
    gap = _DEFAULT_GAP_M if gap_m is None else gap_m
    steps = _steps(list(surfaces.values()))
    grid = np.linspace(0.0, 1.0, steps + 1)
    u, v = np.meshgrid(grid, grid, indexing="ij")
    points = np.array([patch.evaluate(u, v).reshape(-1, 3) for patch in surfaces.values()])
    quads = _grid_faces(steps)
    count = (steps + 1) ** 2
    faces = np.concatenate([quads + i * count for i in range(len(surfaces))])
    owner = np.repeat(np.arange(len(surfaces)), len(quads))

    welded, index = weld(points.reshape(-1, 3), gap)
    faces = index[faces]
    a, b, c = faces.T
    sound = (a != b) & (b != c) & (c != a)
    faces, owner = faces[sound], owner[sound]
    names = list(surfaces)
    _check_edges(faces, owner, names, source, field)
    mesh = trimesh.Trimesh(welded, faces, process=False)
    if mesh.volume <= 0:
        raise InputError(source, field, "all surfaces look inwards: reverse the order of their rows")
    return mesh


def _steps(patches: list[BezierPatch]) -> int:
    """Steps of a grid whose chords leave no surface by more than allowed."""
    points = np.concatenate([patch.control_points.reshape(-1, 3) for patch in patches])
    allowed = _CHORD * float(np.linalg.norm(np.ptp(points, axis=0)))
    bend = 0.0
    for patch in patches:
        for axis, degree in enumerate(patch.degree):
            second = np.diff(patch.control_points, n=2, axis=axis)
            if second.size:
                bend = max(bend, degree * (degree - 1) * float(np.linalg.norm(second, axis=-1).max()))
    return int(np.clip(ceil(sqrt(bend / (8.0 * allowed))), _FEWEST, _MOST))


def _grid_faces(steps: int) -> NDArray[np.int64]:
    """Triangles of a grid of (steps + 1)^2 points, counterclockwise in (u, v)."""
    index = np.arange((steps + 1) ** 2).reshape(steps + 1, steps + 1)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    return np.concatenate(
        [np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)]
    )


def _check_edges(
    faces: NDArray[np.int64], owner: NDArray[np.int64], names: list[str], source: str, field: str
) -> None:
    """Every edge must have one triangle on either side, which run along it in opposite directions."""
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    whose = np.repeat(owner, 3)
    low, high = np.minimum(tails, heads), np.maximum(tails, heads)
    key = low * (faces.max() + 1) + high
    _, inverse, counts = np.unique(key, return_inverse=True, return_counts=True)
    open_edges = counts[inverse] == 1
    if open_edges.any():
        name = names[int(np.bincount(whose[open_edges]).argmax())]
        raise InputError(
            source,
            f"{field}.{name}",
            "the surfaces do not close: an edge of this one meets no other along its whole length "
            "(patch_gap, in m, is how far edges may be apart)",
        )
    if counts.max() > 2:
        name = names[int(whose[counts[inverse] > 2][0])]
        raise InputError(source, f"{field}.{name}", "more than two surfaces meet along an edge of this one")
    order = np.argsort(inverse, kind="stable").reshape(-1, 2)
    along = (tails < heads)[order]
    clash = along[:, 0] == along[:, 1]
    if clash.any():
        wrong = whose[order[clash]]
        name = names[int(np.bincount(wrong.ravel()).argmax())]
        raise InputError(
            source, f"{field}.{name}", "looks the other way than its neighbour: reverse the order of its rows"
        )
