"""Frames of a hand that files give poses of."""

import numpy as np

from ....base.numeric.arrays import Array
from ....geometry import axis_rotation, pose
from ....hands import Hand, forward_kinematics
from ....hands.finding import surface_points

__all__ = ["BASE", "TCP", "grasp_centre", "hand_frames"]

BASE, TCP = "base", "tcp"
# Hands of so few joints are grippers.
_FEW = 2


def hand_frames(hand: Hand) -> dict[str, Array]:
    """Poses (4, 4) in the palm frame of the frames that a file may mean, by name, the palm's own first.

    `tcp` is turned like the palm and lies between the fingertips; what else there is, the model has names
    for. Of a gripper each frame is there a second time, with `+90`, turned by a right angle about the axis
    that points most to its fingertips: jaws open along x in some conventions, along y in others.
    """
    frames = {BASE: np.eye(4)}
    frames |= {name: T for name, T in hand.frames.items() if name not in (BASE, TCP)}
    centre = grasp_centre(hand)
    frames[TCP] = pose(np.eye(3), centre)
    if len(hand.independent) <= _FEW:
        approach = np.eye(3)[int(np.abs(centre).argmax())]
        frames |= {f"{name}+90": _turned(T, T[:3, :3].T @ approach) for name, T in frames.items()}
    return frames


def _turned(T: Array, axis: Array) -> Array:
    """A frame turned by a right angle about its own axis that is next to `axis`."""
    own = np.eye(3)[int(np.abs(axis).argmax())]
    return np.asarray(T @ pose(axis_rotation(own, 0.5 * np.pi), np.zeros(3)))


def grasp_centre(hand: Hand) -> Array:
    """The middle (3,) of the fingertips with all joints in the middle of their range, in the palm frame.

    Of a hand without regions that are called tips it is that of all regions on links that move, and of one
    without these that of the points of the last links that are farthest from the palm.
    """
    Ts = forward_kinematics(hand, hand.expand(hand.limits.mean(axis=1)))
    moving = [region for region in hand.regions.values() if hand.tree.moves[region.link].any()]
    tips = [region for region in moving if region.name.endswith("/tip")] or moving
    points = [Ts[tip.link, :3, :3] @ tip.region.middle()[0] + Ts[tip.link, :3, 3] for tip in tips]
    return np.asarray(np.mean(points or _ends(hand, Ts), axis=0))


def _ends(hand: Hand, Ts: Array) -> list[Array]:
    """The farthest point of each last link in the palm frame; the palm's origin where there is none."""
    found = []
    for i, link in enumerate(hand.links):
        is_last = i > 0 and all(other.parent != i for other in hand.links)
        if is_last and link.shapes:
            points = surface_points(link.shapes) @ Ts[i, :3, :3].T + Ts[i, :3, 3]
            found.append(points[np.linalg.norm(points, axis=1).argmax()])
    return found or [np.zeros(3)]
