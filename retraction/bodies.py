"""The rigid bodies of a task as convex pieces, and their places at a state.

A round shape is a core, a point or a segment, with a radius. FCL then measures between cores, exactly where
it would iterate on the round surface, and two surfaces that touch keep a well-defined normal because their
cores are apart. A polyhedron is its own core, with radius zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import fcl
import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array, Indices, offsets
from ..geometry import (
    Box,
    Capsule,
    Corners,
    Hull,
    PointRegion,
    Shape,
    Sphere,
    furthest,
    hull_edges,
    perpendicular,
    pose,
    transform_points,
)
from ..hands import Hand
from ..objects import Task

__all__ = [
    "FCL_UNITS_PER_M",
    "Bodies",
    "Body",
    "Piece",
    "PlacedBodies",
    "build_piece",
    "corners_of",
    "hand_bodies",
    "object_bodies",
    "support_shape",
]


# FCL wants a radius above zero; the core of a round shape is this thick to it.
_CORE_RADIUS_M = 1e-9
# FCL works in millimetres: its GJK stops at progress below 1e-6 of its own unit, whatever the size of things.
# In metres 1 answer in 50 is off by more than 1 um, in millimetres 1 in 800; much smaller a unit would bring
# that tolerance down to rounding.
FCL_UNITS_PER_M = 1e3
# Of so many vertices, the outermost in many directions at once are sooner found by going uphill for each.
_MANY = 150
# Half extents of the table that stands for a support plane.
_TABLE_M = (1.0, 1.0, 0.25)


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex piece: all points within `radius` of the hull of `core`.

    Attributes:
        core: vertices (n, 3) in the frame of the body, in m.
        radius: in m; zero for boxes and hulls.
        geometry: the core in FCL, in its own frame and unit; that of a round shape is a hair thick.
        T_body_geometry: pose (4, 4) of FCL's frame, in m.
        edges: of the core, as `hull_edges` has them; None where it has few vertices.
    """

    core: Array
    radius: float
    geometry: fcl.CollisionGeometry
    T_body_geometry: Array
    edges: tuple[Indices, Indices] | None = None


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body: a link of the hand, a part of the object or its support.

    Attributes:
        name: of the link, `object/<part>`, or `support`.
        link: index of the link; None for a part of the object and for the support, which goes with it.
        pieces: convex pieces in the body's frame.
    """

    name: str
    link: int | None
    pieces: tuple[Piece, ...]


_Length = TypeVar("_Length", float, Array)


def _to_fcl(length_m: _Length) -> _Length:
    return length_m * FCL_UNITS_PER_M


def build_piece(shape: Shape) -> Piece:
    """The piece of a shape."""
    match shape:
        case Sphere():
            core = np.array(shape.centre)[None, :]
            geometry, T = fcl.Sphere(_to_fcl(_CORE_RADIUS_M)), pose(np.eye(3), shape.centre)
            return Piece(core, shape.radius, geometry, T)
        case Capsule():
            axis = shape.end - shape.start
            length = float(np.linalg.norm(axis))
            R = np.column_stack([*perpendicular(axis / length), axis / length])
            geometry, T = (
                fcl.Capsule(_to_fcl(_CORE_RADIUS_M), _to_fcl(length)),
                pose(R, 0.5 * (shape.start + shape.end)),
            )
            return Piece(np.array([shape.start, shape.end]), shape.radius, geometry, T)
        case Box():
            signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
            corners = signs * shape.half_extents
            core = transform_points(shape.T_link_box, corners)
            return Piece(core, 0.0, fcl.Box(*_to_fcl(2.0 * shape.half_extents)), shape.T_link_box)
        case Hull():
            counted = np.column_stack([np.full(len(shape.faces), 3), shape.faces]).ravel()
            geometry = fcl.Convex(_to_fcl(shape.vertices), len(shape.faces), counted)
            return Piece(shape.vertices, 0.0, geometry, np.eye(4), hull_edges(shape))


def hand_bodies(hand: Hand) -> list[Body]:
    """A body for every link, in the order of the links."""
    return [
        Body(link.name, i, tuple(build_piece(shape) for shape in link.shapes))
        for i, link in enumerate(hand.links)
    ]


def object_bodies(task: Task) -> list[Body]:
    """A body for every part of the object, then one for its support where the task has one."""
    bodies = [
        Body(f"object/{part.name}", None, tuple(build_piece(piece) for piece in part.pieces))
        for part in task.object.parts
    ]
    if task.support is not None:
        bodies.append(Body("support", None, (build_piece(support_shape(task.support)),)))
    return bodies


def support_shape(plane: PointRegion) -> Box:
    """A table whose top lies in a plane, around its point; wider than any hand reaches from there."""
    R = np.column_stack([*perpendicular(plane.normal), plane.normal])
    centre = plane.point - _TABLE_M[2] * plane.normal
    return Box(pose(R, centre), np.array(_TABLE_M))


class Bodies:
    """Bodies with their pieces numbered through and the core vertices of all pieces stacked."""

    def __init__(self, bodies: Sequence[Body]):
        self.bodies = tuple(bodies)
        self.pieces = tuple(piece for body in bodies for piece in body.pieces)
        self.piece_body = np.repeat(np.arange(len(bodies)), [len(body.pieces) for body in bodies])
        self.radius = np.array([piece.radius for piece in self.pieces])
        sizes = [len(piece.core) for piece in self.pieces]
        self.vertex_piece = np.repeat(np.arange(len(self.pieces)), sizes)
        self.starts = offsets(sizes)  # and where the last one ends
        self.vertices = np.concatenate([piece.core for piece in self.pieces])
        self.T_body_geometry = np.array([piece.T_body_geometry for piece in self.pieces])
        none = np.zeros(0, dtype=np.int64)
        edges = [piece.edges or (np.zeros(len(piece.core), dtype=np.int64), none) for piece in self.pieces]
        self._firsts = offsets(np.concatenate([counts for counts, _ in edges]))
        self._neighbours = np.concatenate([neighbours for _, neighbours in edges])
        self._outermost: Indices | None = None

    def outermost(self, count: int) -> Indices:
        """The vertices (n_pieces, count, 2) last found outermost along and against so many directions.

        Where a search begins, no more: what it finds is the same wherever that is.
        """
        if self._outermost is None or self._outermost.shape[1] != count:
            self._outermost = np.zeros((len(self.pieces), count, 2), dtype=np.int64)
        return self._outermost

    def corners_at(self, vertices: Array) -> Corners:
        """The core vertices of all pieces where they are now; neighbours are counted piece by piece."""
        return Corners(vertices, self._firsts, self._neighbours)

    def place(self, Ts_palm_body: Array) -> "PlacedBodies":
        """The bodies at their poses (n_bodies, 4, 4)."""
        T_palm_piece = Ts_palm_body[self.piece_body]
        vertices = _carry(T_palm_piece, self.vertex_piece, self.vertices)
        return PlacedBodies(self, vertices, T_palm_piece @ self.T_body_geometry)


@dataclass(frozen=True, eq=False)
class PlacedBodies:
    """Bodies in the palm frame.

    Attributes:
        bodies: what is placed.
        vertices: core vertices (n, 3) of all pieces, in m.
        T_palm_geometry: poses (n_pieces, 4, 4) of FCL's frames.
    """

    bodies: Bodies
    vertices: Array
    T_palm_geometry: Array

    def core(self, piece: int) -> Array:
        """Core vertices (n, 3) of a piece."""
        return self.vertices[self.bodies.starts[piece] : self.bodies.starts[piece + 1]]

    def extents(self, directions: Array) -> tuple[Array, Array]:
        """Least and greatest coordinate of each core along unit `directions` (k, 3); both (n_pieces, k)."""
        found = self.bodies.outermost(len(directions))
        return _extents(self.bodies.corners_at(self.vertices), self.bodies.starts, directions, found)

    def separations(self, pairs: Indices, normals: Array) -> Array:
        """Gaps (k,) between the cores of pairs (k, 2) of pieces along unit `normals` (k, 3) from a to b."""
        return _separations(self.bodies.corners_at(self.vertices), self.bodies.starts, pairs, normals)

    def fcl_object(self, piece: int, shift: Array | None = None) -> fcl.CollisionObject:
        """A piece as an FCL object at its place, moved by `shift` (3,) where that is given.

        Made anew at each call: FCL's objects carry their pose, so sharing them would tie threads together.
        """
        T = self.T_palm_geometry[piece]
        p = T[:3, 3] if shift is None else T[:3, 3] + shift
        return fcl.CollisionObject(self.bodies.pieces[piece].geometry, fcl.Transform(T[:3, :3], _to_fcl(p)))


# Plain loops: numpy takes ten times as long over so many short rows.
@compiled
def _carry(T_palm_piece: Array, vertex_piece: Indices, vertices: Array) -> Array:
    """Vertices (n, 3) in the palm frame, each moved with its piece."""
    out = np.empty_like(vertices)
    for i in range(len(vertices)):
        T = T_palm_piece[vertex_piece[i]]
        x, y, z = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        for c in range(3):
            out[i, c] = T[c, 0] * x + T[c, 1] * y + T[c, 2] * z + T[c, 3]
    return out


@compiled
def corners_of(corners: Corners, starts: Indices, piece: int) -> Corners:
    """Those of one piece, of the stacked ones of all."""
    first, end = starts[piece], starts[piece + 1]
    return Corners(corners.points[first:end], corners.firsts[first : end + 1], corners.neighbours)


@compiled
def _extents(corners: Corners, starts: Indices, directions: Array, found: Indices) -> tuple[Array, Array]:
    """Extents of all pieces; `found` (n_pieces, k, 2) has where to begin, and then the outermost vertices."""
    shape = (len(starts) - 1, len(directions))
    low, high = np.full(shape, np.inf), np.full(shape, -np.inf)
    for piece in range(shape[0]):
        own = corners_of(corners, starts, piece)
        count = len(own.points)
        if count > _MANY and own.firsts[0] < own.firsts[count]:
            for k in range(shape[1]):
                x, y, z = directions[k, 0], directions[k, 1], directions[k, 2]
                lowest = furthest(own, (-x, -y, -z), found[piece, k, 0])
                highest = furthest(own, (x, y, z), found[piece, k, 1])
                low[piece, k] = _along(own, lowest, directions[k])
                high[piece, k] = _along(own, highest, directions[k])
                found[piece, k, 0], found[piece, k, 1] = lowest, highest
            continue
        for i in range(count):
            x, y, z = own.points[i, 0], own.points[i, 1], own.points[i, 2]
            for k in range(shape[1]):
                along = directions[k, 0] * x + directions[k, 1] * y + directions[k, 2] * z
                low[piece, k] = min(low[piece, k], along)
                high[piece, k] = max(high[piece, k], along)
    return low, high


@compiled
def _separations(corners: Corners, starts: Indices, pairs: Indices, normals: Array) -> Array:
    gaps = np.empty(len(pairs))
    for k in range(len(pairs)):
        x, y, z = normals[k, 0], normals[k, 1], normals[k, 2]
        a, b = corners_of(corners, starts, pairs[k, 0]), corners_of(corners, starts, pairs[k, 1])
        i, j = furthest(a, (x, y, z), 0), furthest(b, (-x, -y, -z), 0)
        gaps[k] = _along(b, j, normals[k]) - _along(a, i, normals[k])
    return gaps


@compiled
def _along(corners: Corners, k: int, direction: Array) -> float:
    """Coordinate of a point along a direction (3,)."""
    points = corners.points
    return points[k, 0] * direction[0] + points[k, 1] * direction[1] + points[k, 2] * direction[2]
