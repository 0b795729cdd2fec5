"""Forward kinematics and Jacobians of all links, in the palm frame."""

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import axis_rotation
from .hand import Hand

__all__ = ["forward_kinematics", "joint_axes", "point_jacobian"]

Array = NDArray[np.float64]


def forward_kinematics(hand: Hand, q: Array) -> Array:
    """Poses T_palm_link (n_links, 4, 4) at the joint vector `q` (n_joints,)."""
    return _walk(hand, q)[0]


def joint_axes(hand: Hand, q: Array) -> tuple[Array, Array, Array]:
    """Link poses with the axes of every joint in the palm frame.

    Returns:
        T_palm_link (n_links, 4, 4), origins (n_joints, 3) in m, unit directions (n_joints, 3).
    """
    return _walk(hand, q)


def _walk(hand: Hand, q: Array) -> tuple[Array, Array, Array]:
    Ts = np.empty((len(hand.links), 4, 4))
    origins = np.empty((len(q), 3))
    directions = np.empty((len(q), 3))
    k = 0
    for i, link in enumerate(hand.links):
        T = link.T_parent_link0 if link.parent < 0 else Ts[link.parent] @ link.T_parent_link0
        T = T.copy()
        for axis in link.axes:
            origins[k] = T[:3, 3]
            directions[k] = T[:3, :3] @ axis.direction
            if axis.kind == "revolute":
                T[:3, :3] = T[:3, :3] @ axis_rotation(axis.direction, float(q[k]))
            else:
                T[:3, 3] += directions[k] * q[k]
            k += 1
        Ts[i] = T
    return Ts, origins, directions


def point_jacobian(hand: Hand, q: Array, link: int, p_palm: Array) -> tuple[Array, Array]:
    """Jacobians of a point that is fixed on a link, and of that link's rotation.

    Args:
        hand: the hand.
        q: joint vector (n_joints,).
        link: index of the link.
        p_palm: the point's present position (3,) in the palm frame, in m.

    Returns:
        J_p (3, n_joints) in m per rad (or m) and J_w (3, n_joints): velocity of the point and angular
        velocity of the link, in the palm frame, per joint velocity.
    """
    _, origins, directions = _walk(hand, q)
    return jacobian_from_axes(hand, origins, directions, link, p_palm)


def jacobian_from_axes(
    hand: Hand, origins: Array, directions: Array, link: int, p_palm: Array
) -> tuple[Array, Array]:
    """`point_jacobian` for axes already computed by `joint_axes`."""
    J_p = np.zeros((3, len(hand.axes)))
    J_w = np.zeros((3, len(hand.axes)))
    for k in hand.ancestors[link]:
        if hand.axes[k].kind == "revolute":
            J_p[:, k] = np.cross(directions[k], p_palm - origins[k])
            J_w[:, k] = directions[k]
        else:
            J_p[:, k] = directions[k]
    return J_p, J_w
