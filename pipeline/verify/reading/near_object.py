"""How far each link of a hand is from the object, at many states."""

from typing import NamedTuple

import numpy as np

from ....base.numeric.arrays import Array, Indices
from ....geometry import Hull
from ....hands import Hand, forward_kinematics
from ....objects import ObjectModel
from ....retraction import Bodies, Body, build_piece, hand_bodies, lower_bounds, measure_quickly
from .states import States

__all__ = ["LinkDistances", "NearObject"]


class LinkDistances(NamedTuple):
    """Links and the object at n states.

    Attributes:
        distance_m: (n, n_links) signed distances from the object's convex pieces; no more than `reach_m` of
            `NearObject`, which stands for anything farther.
        normals: (n, n_links, 3) unit vectors from the link towards the object, in the palm frame; zero for
            what is farther.
        points: (n, n_links, 3) points of the links that are next to the object, or deepest in it, in the palm
            frame in m; zero likewise.
        Ts_palm_link: (n, n_links, 4, 4) where the links are.
    """

    distance_m: Array
    normals: Array
    points: Array
    Ts_palm_link: Array


class NearObject:
    """A hand and an object in any size.

    Args:
        hand: the hand.
        obj: the object with factor 1.
        reach_m: distances beyond it are not measured.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, *, reach_m: float = 0.04):
        self.hand, self.obj, self.reach_m = hand, obj, reach_m
        self._links = hand_bodies(hand)
        self._sizes: dict[tuple[float, ...], tuple[Bodies, Indices]] = {}

    def distances(self, states: States) -> LinkDistances:
        """How far links are from the object at each state."""
        n, links = len(states), len(self._links)
        out = LinkDistances(
            np.full((n, links), self.reach_m),
            np.zeros((n, links, 3)),
            np.zeros((n, links, 3)),
            np.zeros((n, links, 4, 4)),
        )
        for i in range(n):
            self._measure(states, i, out)
        return out

    def corners(self, link: int) -> Array:
        """Corners (k, 4) of a link's convex pieces in its frame, each with the radius around it, in m."""
        return np.concatenate(
            [
                np.column_stack([piece.core, np.full(len(piece.core), piece.radius)])
                for piece in self._links[link].pieces
            ]
        )

    def _measure(self, states: States, i: int, out: LinkDistances) -> None:
        bodies, pairs = self._of_size(states.factors[i])
        out.Ts_palm_link[i] = forward_kinematics(self.hand, states.joints[i])
        placed = bodies.place(np.concatenate([out.Ts_palm_link[i], states.T_palm_object[i][None]]))
        near = pairs[lower_bounds(placed, pairs) < self.reach_m]
        if not len(near):
            return
        gaps = measure_quickly(placed, near)
        links = bodies.piece_body[near[:, 0]]
        # The farthest first, so that the nearest piece of each link is what stays written.
        for k in np.argsort(-gaps.distance_m):
            if gaps.distance_m[k] < self.reach_m:
                link = links[k]
                out.distance_m[i, link] = gaps.distance_m[k]
                out.normals[i, link], out.points[i, link] = gaps.normals[k], gaps.p_a[k]

    def _of_size(self, factor: Array) -> tuple[Bodies, Indices]:
        """The links and the object of a size, and the pairs of their pieces."""
        key = tuple(factor.tolist())
        if key not in self._sizes:
            hulls = [Hull(piece.vertices * factor, piece.faces) for piece in self.obj.pieces]
            body = Body("object", None, tuple(build_piece(hull) for hull in hulls))
            bodies = Bodies([*self._links, body])
            first = len(bodies.pieces) - len(body.pieces)
            grid = np.meshgrid(np.arange(first), np.arange(first, len(bodies.pieces)), indexing="ij")
            self._sizes[key] = bodies, np.array(grid, dtype=np.int64).reshape(2, -1).T.copy()
        return self._sizes[key]
