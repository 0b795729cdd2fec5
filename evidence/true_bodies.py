"""Where the convex pieces of hand and object are, in balls, and how far apart along given directions."""

from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices
from ..retraction import CollisionModel
from ..solver.interval import Balls
from .true_links import TrueLinks

__all__ = ["SLABS", "TrueBodies", "TrueScene"]

SLABS = np.array(
    [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) > (0, 0, 0)],
    dtype=float,
)
"""Directions (13, 3), not of unit length, in which all pieces are measured: of a cube, those of its axes and
diagonals."""


@dataclass(frozen=True, eq=False)
class TrueBodies:
    """All pieces of a collision model, numbered as there.

    Attributes:
        starts: (n_pieces + 1,) where the vertices of each piece begin.
        vertices: core vertices (n, 3) in the palm frame, in m.
        least: (n_pieces, 13) below n . x for all points x of a core, for the directions n of `SLABS`.
        most: (n_pieces, 13) above.
    """

    starts: Indices
    vertices: Balls
    least: Array
    most: Array

    def slab_gaps(self, pairs: Indices) -> Array:
        """Below the gaps (k, 26) between the cores of pairs (k, 2) along `SLABS`, then against them."""
        a, b = pairs.T
        gaps = np.hstack([self.least[b] - self.most[a], self.least[a] - self.most[b]])
        return np.asarray(np.nextafter(gaps, -np.inf))

    def gaps(self, pairs: Indices, normals: Array) -> Array:
        """Below the gaps (k,) of pairs (k, 2) along normals n (k, 3) of any length: n . (b - a) at least."""
        most, least = self._ends(pairs[:, 0], normals)[1], self._ends(pairs[:, 1], normals)[0]
        return np.asarray(np.nextafter(least - most, -np.inf))

    def _ends(self, pieces: Indices, normals: Array) -> tuple[Array, Array]:
        """Below and above n . x over the cores of pieces (k,), each along its own normal."""
        sizes = self.starts[pieces + 1] - self.starts[pieces]
        firsts = np.cumsum(sizes) - sizes
        owner = np.repeat(np.arange(len(pieces)), sizes)
        vertex = np.arange(len(owner)) - firsts[owner] + self.starts[pieces][owner]
        along = (self.vertices[vertex] * normals[owner]).sum(axis=1)
        return _reduced(along, firsts)


class TrueScene:
    """The object, and what it stands on, where it may be, with the hand to be placed.

    Args:
        model: the bodies; those of the hand come first.
        R: rotation (3, 3) of the object.
        p: its position (3,) in m.
    """

    def __init__(self, model: CollisionModel, R: Balls, p: Balls):
        bodies = model.bodies
        self._links = [body.link for body in bodies.bodies if body.link is not None]
        n_pieces = int(np.searchsorted(bodies.piece_body, len(self._links)))
        self._starts = bodies.starts
        self._hand_starts = bodies.starts[: n_pieces + 1]
        self._hand_vertices = bodies.vertices[: self._hand_starts[-1]]
        of_vertex = bodies.piece_body[bodies.vertex_piece[: self._hand_starts[-1]]]
        # Where each link's vertices begin; links without a piece have none.
        self._link_starts = np.searchsorted(of_vertex, np.arange(len(self._links) + 1))
        things = bodies.vertices[self._hand_starts[-1] :] @ R.T + p
        self._things = things
        self._thing_ends = _slab_ends(things, bodies.starts[n_pieces:] - self._hand_starts[-1])

    def at(self, links: TrueLinks) -> TrueBodies:
        """All bodies where the hand's links may be."""
        parts = [
            self._hand_vertices[first:last] @ links.rotations[link].T + links.positions[link]
            for link, first, last in zip(
                self._links, self._link_starts[:-1], self._link_starts[1:], strict=True
            )
        ]
        hand = Balls(np.concatenate([x.mid for x in parts]), np.concatenate([x.rad for x in parts]))
        least, most = _slab_ends(hand, self._hand_starts)
        return TrueBodies(
            self._starts,
            Balls(np.concatenate([hand.mid, self._things.mid]), np.concatenate([hand.rad, self._things.rad])),
            np.concatenate([least, self._thing_ends[0]]),
            np.concatenate([most, self._thing_ends[1]]),
        )


def _slab_ends(vertices: Balls, starts: Indices) -> tuple[Array, Array]:
    """Below and above n . x (n_pieces, 13) over pieces that begin at `starts` (n_pieces + 1,)."""
    if len(starts) == 1:
        return np.zeros((0, len(SLABS))), np.zeros((0, len(SLABS)))
    return _reduced(vertices @ SLABS.T, starts[:-1])


def _reduced(values: Balls, starts: Indices) -> tuple[Array, Array]:
    """Below the least and above the largest of the rows from each start to the next."""
    # Rounding keeps the order, so what has been reduced is rounded as if all had been.
    least = np.minimum.reduceat(values.mid - values.rad, starts, axis=0)
    most = np.maximum.reduceat(values.mid + values.rad, starts, axis=0)
    return np.nextafter(least, -np.inf), np.nextafter(most, np.inf)
