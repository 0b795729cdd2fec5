"""Closed surfaces through a row of closed sections, and the convex pieces of them.

A body of revolution is a loft through its circles, a handle one through its cross-sections. Pieces are hulls
of neighbouring sections, so where the surface is convex they carry the surface itself.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ...base.numeric.arrays import Array
from ..shapes import Hull

__all__ = ["Loft", "hull_depths", "revolve"]

# Sections smaller than this are one point, the pole of a body of revolution.
_POLE_M = 1e-9


@dataclass(frozen=True, eq=False)
class Loft:
    """A surface through closed sections with corresponding points.

    Attributes:
        rings: sections (k, n, 3) in m, in order.
        is_loop: the last section joins the first; otherwise flat lids close both ends.
    """

    rings: Array
    is_loop: bool = False

    def mesh(self) -> trimesh.Trimesh:
        """The closed surface, wound outwards."""
        k, n, _ = self.rings.shape
        vertices = self.rings.reshape(-1, 3)
        quads = self._quads()
        sides = _split(vertices, quads)
        if self.is_loop:
            return _tidy(vertices, sides)
        index = np.arange(k * n).reshape(k, n)
        front, back = index[0], index[-1]
        lids = [
            np.column_stack([np.roll(front, -1), front, np.full(n, k * n)]),
            np.column_stack([back, np.roll(back, -1), np.full(n, k * n + 1)]),
        ]
        return _tidy(np.vstack([vertices, self.rings[[0, -1]].mean(axis=1)]), np.concatenate([sides, *lids]))

    def _quads(self) -> NDArray[np.int64]:
        """Corners (m, 4) of the quadrangles between sections, in order around them."""
        k, n, _ = self.rings.shape
        index = np.arange(k * n).reshape(k, n)
        following = np.roll(index, -1, axis=0)
        a, b, c, d = index, np.roll(index, -1, axis=1), np.roll(following, -1, axis=1), following
        quads = np.stack([a, b, c, d], axis=-1)
        return (quads if self.is_loop else quads[:-1]).reshape(-1, 4)

    def find_cuts(self, tolerance: float | Array) -> tuple[int, ...]:
        """Where to cut it so that each run of sections is as long as its surface stays near that of its hull.

        Args:
            tolerance: how deep the surface may sink into the hull, in m, one for all or one for each section.

        Returns:
            Indices of sections, from the first to the last; in a loop the last is k, the first once more.
        """
        rings = self._all_rings()
        allowed = np.resize(np.broadcast_to(np.asarray(tolerance, dtype=float), len(self.rings)), len(rings))
        cuts = [0]
        while cuts[-1] < len(rings) - 1:
            cuts.append(_longest_run(rings, allowed, cuts[-1]))
        return tuple(cuts)

    def pieces(self, cuts: Sequence[int]) -> tuple[Hull, ...]:
        """Hulls of the runs of sections between cuts."""
        rings = self._all_rings()
        return tuple(Hull.from_points(rings[i : j + 1].reshape(-1, 3)) for i, j in pairwise(cuts))

    def _all_rings(self) -> Array:
        return np.vstack([self.rings, self.rings[:1]]) if self.is_loop else self.rings


def revolve(profile: Array, sides: int) -> Loft:
    """The body of revolution about z of a profile (k, 2) of radii and heights in m."""
    angles = np.arange(sides) * 2.0 * np.pi / sides
    radius, height = profile[:, :1], profile[:, 1:]
    rings = [radius * np.cos(angles), radius * np.sin(angles), np.broadcast_to(height, (len(profile), sides))]
    return Loft(np.stack(rings, axis=-1))


def hull_depths(points: Array) -> Array:
    """How deep each of the points (n, 3) lies below the surface of their hull, in m."""
    equations = ConvexHull(points).equations
    return np.asarray(np.min(-(points @ equations[:, :3].T + equations[:, 3]), axis=1))


def _longest_run(rings: Array, allowed: Array, start: int) -> int:
    """The last section of the longest run from `start` whose hull is within tolerance; at least the next."""

    def fits(end: int) -> bool:
        depth = hull_depths(rings[start : end + 1].reshape(-1, 3))
        return bool(depth.max() <= allowed[start : end + 1].min())

    last = len(rings) - 1
    good, step = start + 1, 1
    while good < last and fits(min(good + step, last)):
        good, step = min(good + step, last), 2 * step
    bad = min(good + step, last + 1)
    while bad - good > 1:
        middle = (good + bad) // 2
        good, bad = (middle, bad) if fits(middle) else (good, middle)
    return good


def _split(vertices: Array, quads: NDArray[np.int64]) -> NDArray[np.int64]:
    """Two triangles for each quadrangle, along the diagonal farther outside, as in a convex body."""
    a, b, c, d = np.moveaxis(vertices[quads], 1, 0)
    normal = np.cross(c - a, d - b)
    # The whole encloses a volume of the sign of its winding.
    outwards = np.sign(np.sum(normal * (a + b + c + d)))
    rise = outwards * np.sum((a + c - b - d) * normal, axis=1)
    along_ac = (rise >= 0)[:, None]
    first = np.where(along_ac, quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(along_ac, quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.concatenate([first, second])


def _tidy(vertices: Array, faces: NDArray[np.int64]) -> trimesh.Trimesh:
    """Poles become single points; the surface is turned outwards."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.merge_vertices(digits_vertex=round(-np.log10(_POLE_M)))
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()
    if mesh.volume < 0:
        mesh.invert()
    return mesh
