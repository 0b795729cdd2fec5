"""Closing a gripper on an object, where a file gives the pose of the gripper alone."""

from dataclasses import replace
from itertools import product

import numpy as np

from ....base.numeric.arrays import Array
from ....errors import InputError
from ....hands import Hand, forward_kinematics
from .fingers import finger_links
from .near_object import NearObject
from .states import States

__all__ = ["Jaw"]

# Hands with more joints than this don't close in one way.
_MOST_JOINTS = 2
_STEPS, _HALVINGS = 12, 14
# How far an object is moved at most, and how often it is moved and the jaws closed again.
_MOST_SHIFT_M, _CENTRINGS = 4e-3, 3


class Jaw:
    """A hand of one or two joints, which opens and closes in one way.

    Args:
        hand: the hand.

    Attributes:
        open: (n_joints,) where its fingers are farthest apart.

    Raises:
        InputError: it has more joints.
    """

    def __init__(self, hand: Hand):
        self.hand = hand
        n = len(hand.independent)
        if not 1 <= n <= _MOST_JOINTS:
            raise InputError(
                "verify",
                "joints",
                f"the file gives poses alone, and hand {hand.name} has {n} joints: only of a gripper with "
                "one or two is it clear how it closes",
            )
        self._fingers = list(finger_links(hand).values())
        ends = [hand.expand(np.array(corner)) for corner in product(*hand.limits.tolist())]
        widths = [self._width(q) for q in ends]
        self.open, self._closed = ends[int(np.argmax(widths))], ends[int(np.argmin(widths))]

    def close(self, states: States, near: NearObject) -> States:
        """The states with the jaws closed until, taken together, they touch."""
        joints = states.joints.copy()
        for i in range(len(states)):
            joints[i] = self._close_one(states.only(np.array([i])), near)
        return replace(states, joints=joints)

    def centre(self, states: States, near: NearObject) -> States:
        """Closed states with objects moved along the way of the jaws to where both touch.

        Poses alone are seldom exact across the jaws: of a gripper that closes, the finger that touches first
        moves the object, or a soft arm, until the other touches as well. What would have to move by more than
        a few millimetres stays.
        """
        moved = states
        for _ in range(_CENTRINGS):
            T = moved.T_palm_object.copy()
            for i in range(len(moved)):
                T[i, :3, 3] += self._shift(moved.only(np.array([i])), near)
            moved = self.close(replace(moved, T_palm_object=T), near)
        way = np.linalg.norm(moved.T_palm_object[:, :3, 3] - states.T_palm_object[:, :3, 3], axis=1)
        kept = (way > _MOST_SHIFT_M)[:, None]
        return replace(
            moved,
            joints=np.where(kept, states.joints, moved.joints),
            T_palm_object=np.where(kept[..., None], states.T_palm_object, moved.T_palm_object),
        )

    def _shift(self, state: States, near: NearObject) -> Array:
        """By what (3,) an object has to move, in the palm frame, so that two fingers are as near to it."""
        if len(self._fingers) != 2:
            return np.zeros(3)
        first, second = (float(near.distances(state).distance_m[0, links].min()) for links in self._fingers)
        if max(abs(first), abs(second)) > _MOST_SHIFT_M:
            return np.zeros(3)
        Ts = forward_kinematics(self.hand, state.joints[0])
        between = self._ends(Ts, 0) - self._ends(Ts, 1)
        length = float(np.linalg.norm(between))
        return 0.5 * (first - second) * between / length if length > 0.0 else np.zeros(3)

    def _ends(self, Ts: Array, finger: int) -> Array:
        """The middle (3,) of a finger's tips in the palm frame; of its last link, where it has none."""
        links = self._fingers[finger]
        found = [
            Ts[tip.link, :3, :3] @ tip.region.middle()[0] + Ts[tip.link, :3, 3]
            for name, tip in self.hand.regions.items()
            if name.endswith("/tip") and tip.link in links
        ]
        return np.asarray(np.mean(found or [Ts[links[-1], :3, 3]], axis=0))

    def _close_one(self, state: States, near: NearObject) -> Array:
        low = 0.0
        if self._gap_m(state, np.array([low]), near)[0] >= 2.0 * near.reach_m:
            return self.open  # the object is nowhere near
        shares = np.linspace(0.0, 1.0, _STEPS + 1)
        gaps = self._gap_m(state, shares, near)
        reached = np.flatnonzero(gaps <= 0.0)
        if not len(reached):
            return self._closed
        if reached[0] == 0:
            return self.open
        low, high = float(shares[reached[0] - 1]), float(shares[reached[0]])
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self._gap_m(state, np.array([middle]), near)[0] > 0.0:
                low = middle
            else:
                high = middle
        return self._at(0.5 * (low + high))

    def _gap_m(self, state: States, shares: Array, near: NearObject) -> Array:
        """Sums (n,) of the fingers' distances from the object, at shares of the way from open to closed.

        An object that is off the middle lets one finger sink in as deep as the other stands off: a real
        gripper would shift it, or itself.
        """
        n = len(shares)
        along = States(
            np.array([self._at(share) for share in shares]),
            np.tile(state.T_palm_object, (n, 1, 1)),
            np.tile(state.factors, (n, 1)),
        )
        distance_m = near.distances(along).distance_m
        return np.asarray(sum(distance_m[:, links].min(axis=1) for links in self._fingers))

    def _at(self, share: float) -> Array:
        return (1.0 - share) * self.open + share * self._closed

    def _width(self, q: Array) -> float:
        """How far apart the ends of the fingers are."""
        Ts = forward_kinematics(self.hand, q)
        cloud = np.array([self._ends(Ts, finger) for finger in range(len(self._fingers))])
        return float(np.linalg.norm(cloud[:, None] - cloud[None], axis=2).max())
