"""Frames of a hand that files give poses of."""

import numpy as np

from ....arrays import Array
from ....geometry import pose
from ....hands import Hand, forward_kinematics

__all__ = ["BASE", "TCP", "grasp_centre", "hand_frames"]

BASE, TCP = "base", "tcp"


def hand_frames(hand: Hand) -> dict[str, Array]:
    """Poses (4, 4) in the palm frame of the frames that a file may mean, by name, the palm's own first.

    `tcp` is turned like the palm and lies between the fingertips; what else there is, the model has names
    for.
    """
    frames = {BASE: np.eye(4)}
    frames |= {name: T for name, T in hand.frames.items() if name not in (BASE, TCP)}
    frames[TCP] = pose(np.eye(3), grasp_centre(hand))
    return frames


def grasp_centre(hand: Hand) -> Array:
    """The middle (3,) of the fingertips with all joints in the middle of their range, in the palm frame."""
    Ts = forward_kinematics(hand, hand.expand(hand.limits.mean(axis=1)))
    tips = [region for name, region in hand.regions.items() if name.endswith("/tip")]
    points = [Ts[tip.link, :3, :3] @ tip.region.middle()[0] + Ts[tip.link, :3, 3] for tip in tips]
    if points:
        return np.asarray(np.mean(points, axis=0))
    last = [i for i in range(1, len(hand.links)) if not any(link.parent == i for link in hand.links)]
    return np.asarray(Ts[last, :3, 3].mean(axis=0)) if last else np.zeros(3)
