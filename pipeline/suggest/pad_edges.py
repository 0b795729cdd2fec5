"""Edges of flat pads as contact regions: what they touch a hollow wall with, such as the inside of a rim.

A pad that is tangent to a hollow wall would sink into it by its sides; a real one stands on two of its edges.
Each is a strip along the side of the pad that leans outwards, as a worn edge does, so that there is room on
both sides of its normal.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Patch, Shape, perpendicular, shape_mesh
from ...hands import Hand, HandRegion

__all__ = ["EDGE_ROOM_DEG", "PadEdges", "is_edge", "is_pad", "pad_edges"]

EDGE_ROOM_DEG = 15.0
"""By how much the normal of a wall may differ from that of a strip, which leans by a little more."""

_LEAN = np.tan(np.radians(20.0))
_WIDTH_M = 1.2e-4
# What lies so little below the plane of a pad belongs to its face, and what so near to its side to that edge.
_FLAT_M, _SIDE_M = 1.5e-4, 3e-4
_SHORTEST_M = 4e-3
# Edges are so near to the middle of the pad.
_ASIDE_M = 0.02
# Strips reach so far along the edge from the middle of the pad, whose face leans by less and is this near.
_BESIDE_M, _LIKE_PAD, _NEAR_M = 0.012, np.cos(np.radians(6.0)), 1e-3
_PADS = ("tip", "pad")
_DIGITS = 7
_MARK = "/edge_"


class PadEdges(NamedTuple):
    """Two opposite edges of the flat face in which a pad lies.

    Attributes:
        link: its number.
        edges: strips along both.
        span_m: how far they are apart.
        along: (3,) unit vector along them, in the frame of the link.
    """

    link: int
    edges: tuple[HandRegion, HandRegion]
    span_m: float
    along: Array


def is_edge(region: HandRegion) -> bool:
    """Whether a region is one of those that are made here."""
    return _MARK in region.name


def is_pad(region: HandRegion) -> bool:
    """Whether a region is a fingertip or a pad, by its name."""
    return region.name.endswith(_PADS)


def pad_edges(hand: Hand) -> list[PadEdges]:
    """Pairs of edges of the flat faces in which tips and pads lie, at most two pairs for each link."""
    found: dict[int, list[PadEdges]] = {}
    for region in hand.regions.values():
        if not (is_pad(region) and isinstance(region.region, Patch)) or found.get(region.link):
            continue
        found[region.link] = _pairs(hand, region.link, *region.region.middle())
    return [pair for pairs in found.values() for pair in pairs]


def _pairs(hand: Hand, link: int, middle: Array, leaning: Array) -> list[PadEdges]:
    face, normal = _face(hand.links[link].shapes, middle, leaning)
    if len(face) < 3:
        return []
    height = float(np.mean(face @ normal))
    first = _side(face, normal)
    pairs: list[PadEdges] = []
    for across, along in ((first, np.cross(normal, first)), (np.cross(normal, first), first)):
        t, s = face @ across, face @ along
        strips = []
        for sign in (-1.0, 1.0):
            side = float((sign * t).max())
            on_side = s[sign * t > side - _SIDE_M]
            # Only beside the pad: further away, other things may be in the way.
            low = max(float(middle @ along) - _BESIDE_M, on_side.min())
            high = min(float(middle @ along) + _BESIDE_M, on_side.max())
            if high - low >= _SHORTEST_M and side - sign * float(middle @ across) <= _ASIDE_M:
                strips.append(_strip(sign * across, side, along, (low, high), normal, height))
        if len(strips) == 2:
            names = (f"{hand.links[link].name}{_MARK}{2 * len(pairs) + i}" for i in (1, 2))
            edges = [HandRegion(name, link, strip) for name, strip in zip(names, strips, strict=True)]
            pairs.append(PadEdges(link, (edges[0], edges[1]), float(np.ptp(t)), along))
    return pairs


def _face(shapes: tuple[Shape, ...], middle: Array, leaning: Array) -> tuple[Array, Array]:
    """Corners (n, 3) and normal (3,) of the largest flat face near a pad; no corners where there is none."""
    largest, corners, normal = 0.0, np.zeros((0, 3)), leaning
    for shape in shapes:
        mesh = shape_mesh(shape)
        normals = np.array(mesh.face_normals)
        for i in np.flatnonzero(normals @ leaning > _LIKE_PAD):
            heights = mesh.triangles @ normals[i]
            height = float(heights[i].mean())
            in_plane = np.abs(heights - height).max(axis=1) <= _FLAT_M
            area = float(mesh.area_faces[in_plane].sum())
            if area <= 1.01 * largest or abs(middle @ normals[i] - height) > _NEAR_M:
                continue
            face = np.unique(mesh.triangles[in_plane].reshape(-1, 3), axis=0)
            low, high = face.min(axis=0) - _NEAR_M, face.max(axis=0) + _NEAR_M
            if np.all((low <= middle) & (middle <= high)):
                largest, corners, normal = area, face, normals[i]
    return corners, normal


def _side(face: Array, normal: Array) -> Array:
    """Unit vector (3,) along the longest side of a flat face."""
    e1, e2 = perpendicular(normal)
    flat = face @ np.column_stack([e1, e2])
    corners = flat[ConvexHull(flat).vertices]
    sides = np.roll(corners, -1, axis=0) - corners
    longest = sides[int(np.argmax(np.linalg.norm(sides, axis=1)))]
    return np.asarray((longest[0] * e1 + longest[1] * e2) / np.linalg.norm(longest))


def _strip(
    out: Array, side: float, along: Array, ends: tuple[float, float], normal: Array, height: float
) -> Patch:
    """A strip whose outer side lies at `side` along `out`, lower than the face by what it leans."""
    inner, outer = (side - _WIDTH_M) * out + height * normal, side * out + height * normal
    outer = outer - _WIDTH_M * _LEAN * normal
    net = np.array([[line + end * along for end in ends] for line in (inner, outer)])
    faces_out = np.cross(out, along) @ normal > 0.0
    return Patch(BezierPatch(np.round(net if faces_out else net[::-1], _DIGITS)))
