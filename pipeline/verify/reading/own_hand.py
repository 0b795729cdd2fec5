"""How deep the bodies of a hand are in each other: what a hand read rightly seldom has."""

from itertools import combinations

import numpy as np

from ....base.numeric.arrays import Array
from ....hands import Hand, forward_kinematics
from ....retraction import Bodies, hand_bodies, lower_bounds, measure_quickly, overlapping_links
from .states import States

__all__ = ["OwnHand"]

# Makers of grasps tolerate so much; every so much beyond counts one, up to the most.
_TOLERATED_M, _UNIT_M, _MOST = 5e-4, 5e-4, 8.0


class OwnHand:
    """The bodies of a hand.

    Args:
        hand: the hand.
    """

    def __init__(self, hand: Hand):
        self._hand = hand
        self._bodies = Bodies(hand_bodies(hand))
        left_out = overlapping_links(hand)
        of = [np.flatnonzero(self._bodies.piece_body == i) for i in range(len(hand.links))]
        grids = [
            np.array(np.meshgrid(of[a], of[b], indexing="ij")).reshape(2, -1).T
            for a, b in combinations(range(len(of)), 2)
            if (a, b) not in left_out
        ]
        self._pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *grids])

    def depths(self, states: States) -> Array:
        """How deep (n,) the deepest two bodies are in each other, in m, at least 0."""
        out = np.zeros(len(states))
        for i, joints in enumerate(states.joints):
            placed = self._bodies.place(forward_kinematics(self._hand, joints))
            near = self._pairs[lower_bounds(placed, self._pairs) < 0.0]
            if len(near):
                out[i] = max(0.0, -float(measure_quickly(placed, near).distance_m.min()))
        return out

    def log_likelihood(self, states: States) -> Array:
        """What that says (n,) of readings, as a logarithm of likelihood: at most 0."""
        return -np.clip((self.depths(states) - _TOLERATED_M) / _UNIT_M, 0.0, _MOST)
