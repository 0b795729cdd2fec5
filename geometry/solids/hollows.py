"""Convex pieces that bridge hollows are cut in two, again and again, until they lie near the surface.

What CoACD leaves across a hollow, such as the inside of a ring or the wall of a mug, is a chord that it takes
for near enough. Here each piece is what of the solid lies in it; the one whose hull stands out furthest is
cut by the plane that leaves the least volume in the two hulls, which takes milliseconds.
"""

import heapq
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import manifold3d
import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ..shapes import Hull
from .closeness import SurfaceDistance, width_m
from .manifold import from_hull, from_manifold, to_manifold

__all__ = ["cut_at_hollows", "planes", "split"]

# Pieces that stand out by no more are left alone: by very little while there are few, by what still lets a
# finger find places on the surface up to a number that costs little where bodies collide.
_NEAR_M, _FEW_PIECES = 1.5e-4, 64
_FAR_M, _MOST_PIECES = 5e-4, 160
# Where planes across a piece's principal axes are tried, in shares of its extent.
_SHARES = (0.35, 0.5, 0.65)
# So many faces about the corner that lies deepest in the hull give planes as well.
_MOST_FACES = 6
# Points by which the space between a piece and its hull is measured.
_CORNERS, _SAMPLES = 300, 60
# Volumes below this share of the size cubed are nothing.
_NOTHING = 1e-9


@dataclass(order=True)
class _Part:
    """What of a solid lies in a piece; in a heap the one that stands out furthest comes first.

    Attributes:
        less_m: how far its hull stands out, negative.
        number: of its making, which decides between equals.
        body: that part of the solid.
    """

    less_m: float
    number: int
    body: manifold3d.Manifold = field(compare=False)


def cut_at_hollows(
    pieces: Sequence[Hull], mesh: trimesh.Trimesh, *, until_s: float | None = None
) -> list[Hull]:
    """Pieces that lie nearer to a closed surface and cover the same of its inside.

    Args:
        pieces: convex pieces of what the surface bounds.
        mesh: the surface, in m; the pieces come back as they are where it bounds no solid.
        until_s: by the clock that never goes back, after which nothing is cut further; None cuts to the end.
    """
    solid = to_manifold(mesh)
    if solid is None:
        return list(pieces)
    surface = SurfaceDistance(mesh)
    least = _NOTHING * float(mesh.scale) ** 3
    found = [from_hull(piece) ^ solid for piece in pieces]
    parts: list[_Part] = []
    whole: list[manifold3d.Manifold] = []
    made = 0
    while True:
        for body in found:
            if body.volume() > least:
                made += 1
                space = body.hull() - solid
                stands_out_m = width_m(space, surface, most_corners=_CORNERS, samples=_SAMPLES)
                heapq.heappush(parts, _Part(-stands_out_m, made, body))
        is_over = until_s is not None and time.monotonic() > until_s
        if is_over or not parts or _is_near(-parts[0].less_m, len(parts) + len(whole)):
            break
        body = heapq.heappop(parts).body
        found = _cut(body)
        if not found:
            whole.append(body)
    bodies = [*whole, *(part.body for part in sorted(parts, key=lambda part: part.number))]
    return [Hull.from_points(from_manifold(body).vertices) for body in bodies] or list(pieces)


def _is_near(stands_out_m: float, pieces: int) -> bool:
    """Whether what stands out furthest may, with so many pieces."""
    if pieces >= _MOST_PIECES:
        return True
    return stands_out_m <= (_NEAR_M if pieces < _FEW_PIECES else _FAR_M)


def _cut(body: manifold3d.Manifold) -> list[manifold3d.Manifold]:
    """The bodies on both sides of the best plane; none where no plane parts it.

    The best one takes the most volume out of the hulls for each body that it adds.
    """
    whole, most, best = body.hull().volume(), -np.inf, []
    for normal, offset in planes(body):
        bodies = split(body, normal, offset)
        if len(bodies) < 2:
            continue
        gain = (whole - sum(part.hull().volume() for part in bodies)) / (len(bodies) - 1)
        if gain > most:
            most, best = gain, bodies
    return best


def split(body: manifold3d.Manifold, normal: Array, offset: float) -> list[manifold3d.Manifold]:
    """The connected bodies on both sides of a plane, by its unit normal (3,) and offset in m."""
    sides = [side for side in body.split_by_plane(normal, offset) if not side.is_empty()]
    return [part for side in sides for part in side.decompose()]


def planes(body: manifold3d.Manifold) -> Iterator[tuple[Array, float]]:
    """Planes to try, by unit normal (3,) and offset in m.

    They lie across its axes, and along the faces at the corner that is deepest in its hull.
    """
    mesh = from_manifold(body)
    corners = np.array(mesh.vertices)
    axes = np.linalg.svd(corners - corners.mean(axis=0), full_matrices=False)[2]
    for axis in axes:
        heights = corners @ axis
        low, high = float(heights.min()), float(heights.max())
        for share in _SHARES:
            yield axis, low + share * (high - low)
    hull = from_manifold(body.hull())
    sound = hull.area_faces > 0.0
    offsets = np.sum(hull.face_normals[sound] * hull.triangles[sound, 0], axis=1)
    deepest = int(np.argmin(np.max(corners @ hull.face_normals[sound].T - offsets, axis=1)))
    for face in np.flatnonzero(np.any(mesh.faces == deepest, axis=1))[:_MOST_FACES]:
        normal = np.array(mesh.face_normals[face])
        if normal.any():
            yield normal, float(normal @ corners[deepest])
