"""Meshes whose hull bridges a hollow where the hand touches are cut into convex pieces.

A mesh collides as its convex hull. Over a hook or between the rails of a jaw that hull is air, and a region
that lies on it lies before the finger, or leans as no pad of it does. Elsewhere a hull that stands out costs
room at most, so that meshes are cut where regions lie alone, and of the last links of fingers.
"""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ...errors import InputError, InputWarning
from ...geometry import MOST_OFF_M, Hull, Region, Shape
from ...geometry.solids import CarvedSolid, SurfaceDistance, closed_mesh
from ..hand import Hand, HandRegion

__all__ = ["with_hollows"]

# Regions are found anew so often, each time on pieces that were cut where the last ones lay.
_ROUNDS = 4
# Steps on the way from a region to the mesh, each half as far as the mesh is.
_STEPS = 10
# How far below the shapes it begins, in shares of how far a region may lie off.
_BELOW = (0.02, 0.1, 0.3)


class _Part:
    """A shape of a link, or the pieces into which it was cut.

    Attributes:
        shapes: what stands for it.
    """

    def __init__(self, shape: Shape, mesh: trimesh.Trimesh | None) -> None:
        self.shapes: tuple[Shape, ...] = (shape,)
        self._mesh = mesh
        self._surface = None if mesh is None else SurfaceDistance(mesh)
        self._solid: CarvedSolid | None = None

    def bridged(self, region: Region) -> Array:
        """Points (n, 3) that must be free for a region that lies on the shapes, but off the mesh, or in them.

        None where half of the region lies on both, as it should, or elsewhere altogether.
        """
        points, normals = region.spread()
        if self._surface is None or region.off_surface:
            return points[:0]
        off_m = self._surface.of(points)
        outside_m = self._outside_m(points)
        if float(np.median(off_m)) > MOST_OFF_M:
            on_shapes = float(np.median(np.abs(outside_m))) <= MOST_OFF_M
            return self._air(points[off_m > MOST_OFF_M], normals[off_m > MOST_OFF_M], on_shapes)
        is_buried = float(np.median(outside_m)) < -MOST_OFF_M
        return points + MOST_OFF_M * normals if is_buried else points[:0]

    def _outside_m(self, points: Array) -> Array:
        """How far points (n, 3) lie outside of the shapes' planes, negative inside, in m."""
        outside_m = np.full(len(points), np.inf)
        for shape in self.shapes:
            assert isinstance(shape, Hull)
            normals, offsets = shape.planes
            outside_m = np.minimum(outside_m, np.max(points @ normals.T - offsets, axis=1))
        return outside_m

    def _air(self, points: Array, normals: Array, on_shapes: bool) -> Array:
        """Points (n, 3) on the way from a region to the mesh before which it lies, against its normals."""
        assert self._surface is not None
        # Just below a hull, which may be a little smaller where it is made anew, and thin.
        way = [points - share * MOST_OFF_M * normals for share in _BELOW if on_shapes]
        while on_shapes and len(points) and len(way) <= _STEPS:
            # No step leads through the surface.
            off_m = self._surface.of(points)
            is_free = off_m > MOST_OFF_M
            points = (points - 0.5 * off_m[:, None] * normals)[is_free]
            normals = normals[is_free]
            way.append(points)
        return np.concatenate([points[:0], *way])

    def free(self, points: Array) -> bool:
        """Cuts it so that it does not hold the points; whether that changed it."""
        assert self._mesh is not None
        if self._solid is None:
            try:
                solid, _ = closed_mesh(self._mesh.copy(), "mesh", "", "")
            except InputError:  # what bounds no solid keeps its hull
                return False
            self._solid = CarvedSolid(solid)
        is_cut = self._solid.free(points)
        if is_cut:
            self.shapes = self._solid.hulls
        return is_cut


def with_hollows(
    hand: Hand,
    meshes: Sequence[Sequence[trimesh.Trimesh | None]],
    regions_of: Callable[[Hand], dict[str, HandRegion]],
) -> tuple[Hand, list[str]]:
    """The hand with its regions, and with pieces for meshes that are hollow where these lie.

    Args:
        hand: its links have the hulls of meshes as shapes.
        meshes: for each link the meshes of its shapes, in its frame; None for other shapes.
        regions_of: finds the regions of a hand, with warnings, or has them.

    Returns:
        The hand, and what was cut, in words.
    """
    parts = [
        [_Part(shape, mesh) for shape, mesh in zip(link.shapes, own, strict=True)]
        for link, own in zip(hand.links, meshes, strict=True)
    ]
    hand, told = _with_regions(hand, regions_of)
    for _ in range(_ROUNDS):
        if not _cut(hand, parts):
            break
        links = [
            replace(link, shapes=tuple(shape for part in own for shape in part.shapes))
            for link, own in zip(hand.links, parts, strict=True)
        ]
        hand, told = _with_regions(replace(hand, links=tuple(links)), regions_of)
    for warning in told:
        warnings.warn(warning, stacklevel=2)
    cut = [
        f"{link.name} ({sum(len(part.shapes) for part in own)})"
        for link, own in zip(hand.links, parts, strict=True)
        if any(len(part.shapes) > 1 for part in own)
    ]
    notes = (
        [f"meshes that are hollow where they touch, cut into convex pieces: {', '.join(cut)}"] if cut else []
    )
    left = [
        name
        for name, entry in hand.regions.items()
        if any(len(part.bridged(entry.region)) for part in parts[entry.link])
    ]
    if left:
        notes.append(
            "lie before the mesh of their link, whose convex hull bridges a hollow there: " + ", ".join(left)
        )
    return hand, notes


def _with_regions(
    hand: Hand, regions_of: Callable[[Hand], dict[str, HandRegion]]
) -> tuple[Hand, list[InputWarning]]:
    """The hand with its regions, and what finding them warned of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        hand = replace(hand, regions=regions_of(hand))
    return hand, [entry.message for entry in caught if isinstance(entry.message, InputWarning)]


def _cut(hand: Hand, parts: list[list[_Part]]) -> bool:
    """Cuts parts of the last links of fingers that bridge hollows where regions lie; whether there were any.

    Palms and inner links are full of hollows, and few grasps touch them: they keep their hulls.
    """
    inner = {0, *(link.parent for link in hand.links)}
    is_cut = False
    for entry in hand.regions.values():
        for part in parts[entry.link] if entry.link not in inner else []:
            points = part.bridged(entry.region)
            is_cut |= len(points) > 0 and part.free(points)
    return is_cut
