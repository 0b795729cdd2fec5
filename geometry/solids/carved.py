"""A solid in convex pieces, cut only where their hulls must not be.

A hull that stands out costs little where nothing comes. So a solid needs few pieces where only some of its
hollows matter: a piece that holds a point of such a hollow is parted by the plane that frees most of the
points, which is mostly that of the hollow's floor.
"""

from collections.abc import Iterator

import manifold3d
import numpy as np
import trimesh

from ...base.numeric.arrays import Array, Mask
from ..shapes import Hull
from .closeness import SurfaceDistance
from .decompose import simplified
from .hollows import planes, split
from .manifold import from_manifold, to_manifold

__all__ = ["CarvedSolid"]

# Points so near to a hull, in m, count as inside.
_ON_M = 1e-5
# Pieces at most.
_MOST_PIECES = 32
# Of the points that a piece holds so many give planes.
_MOST_FLOORS = 6
# Bodies below this share of the size cubed are nothing.
_NOTHING = 1e-9


class CarvedSolid:
    """Convex pieces that cover a solid: at first its hull, then cut at what is to be free."""

    def __init__(self, mesh: trimesh.Trimesh) -> None:
        """Begins with the hull.

        Args:
            mesh: closed surface, outward normals, in m; one of many triangles is made simpler, by at most a
                thousandth of its size.
        """
        mesh = simplified(mesh)
        solid = to_manifold(mesh)
        self._bodies = [] if solid is None else [solid]
        self._surface = SurfaceDistance(mesh)
        self._least = _NOTHING * float(mesh.scale) ** 3

    @property
    def hulls(self) -> tuple[Hull, ...]:
        """The pieces."""
        return tuple(_hull(body) for body in self._bodies)

    def free(self, points: Array) -> bool:
        """Cuts pieces until none of them holds any of the points (n, 3), which lie outside of the surface.

        Returns:
            Whether anything was cut: not where the surface bounds no solid, or there are too many pieces.
        """
        pieces = len(self._bodies)
        done: list[manifold3d.Manifold] = []
        while self._bodies and len(self._bodies) + len(done) < _MOST_PIECES:
            body = self._bodies.pop()
            held = _held(body, points)
            parted = self._part(body, points[held]) if held.any() else []
            if parted:
                self._bodies += parted
            else:
                done.append(body)
        self._bodies += done
        return len(self._bodies) > pieces

    def _part(self, body: manifold3d.Manifold, points: Array) -> list[manifold3d.Manifold]:
        """The bodies on both sides of the plane that leaves least points in hulls; none if none parts it.

        Of equals it is the one that leaves the least volume in the hulls. Other planes than those of floors
        are only tried where these leave points.
        """
        least, best = (np.inf, np.inf), []
        floors = list(self._floors(points))
        for i, (normal, offset) in enumerate([*floors, *planes(body)]):
            if i >= len(floors) and not least[0]:
                break
            bodies = [part for part in split(body, normal, offset) if part.volume() > self._least]
            if len(bodies) < 2:
                continue
            left = (
                sum(int(_held(part, points).sum()) for part in bodies),
                sum(part.hull().volume() for part in bodies),
            )
            if left < least:
                least, best = left, bodies
        return best

    def _floors(self, points: Array) -> Iterator[tuple[Array, float]]:
        """Planes through the surface's nearest places to some of the points, across the way there."""
        for point in points[:: max(1, len(points) // _MOST_FLOORS)]:
            floor = self._surface.nearest(point[None])[0]
            way = point - floor
            length_m = float(np.linalg.norm(way))
            if length_m > 0.0:
                yield way / length_m, float(way @ floor) / length_m


def _held(body: manifold3d.Manifold, points: Array) -> Mask:
    """Which of the points (n, 3) lie in the hull of a body."""
    normals, offsets = _hull(body).planes
    return np.asarray(np.all(points @ normals.T <= offsets + _ON_M, axis=1))


def _hull(body: manifold3d.Manifold) -> Hull:
    # Of the corners of manifold3d's hull, whose slivers may face anywhere.
    return Hull.from_points(from_manifold(body.hull()).vertices)
