"""Forward kinematics and Jacobians of all links, in the palm frame."""

import numpy as np
from numpy.typing import NDArray

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array
from .hand import Hand

__all__ = ["forward_kinematics", "jacobian_from_axes", "joint_axes", "place_links", "point_jacobian"]


def forward_kinematics(hand: Hand, q: Array) -> Array:
    """Poses T_palm_link (n_links, 4, 4) at the joint vector `q` (n_joints,), in rad or m."""
    return joint_axes(hand, q)[0]


def joint_axes(hand: Hand, q: Array) -> tuple[Array, Array, Array]:
    """Link poses with the axes of every joint in the palm frame, at the joint vector `q` (n_joints,).

    Returns:
        T_palm_link (n_links, 4, 4), origins (n_joints, 3) in m, unit directions (n_joints, 3).

    Raises:
        ValueError: `q` has another length.
    """
    q = np.array(q, dtype=float)
    tree = hand.tree
    if q.shape != tree.prismatic.shape:
        raise ValueError(f"a joint vector of {hand.name} has shape {tree.prismatic.shape}, not {q.shape}")
    return place_links(tree.parents, tree.n_axes, tree.T_parent_link0, tree.directions, tree.prismatic, q)


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
    _, origins, directions = joint_axes(hand, q)
    return jacobian_from_axes(hand, origins, directions, link, p_palm)


def jacobian_from_axes(
    hand: Hand, origins: Array, directions: Array, link: int, p_palm: Array
) -> tuple[Array, Array]:
    """`point_jacobian` for axes already computed by `joint_axes`."""
    tree = hand.tree
    p = np.array(p_palm, dtype=float)
    return _jacobian(tree.moves[link], tree.prismatic, origins, directions, p)


@compiled
def place_links(
    parents: NDArray[np.int64],
    n_axes: NDArray[np.int64],
    T_parent_link0: Array,
    axis_directions: Array,
    prismatic: NDArray[np.bool_],
    q: Array,
) -> tuple[Array, Array, Array]:
    """`joint_axes`, compiled: of a `KinematicTree`'s arrays and a joint vector (n_joints,)."""
    Ts = np.zeros((len(parents), 4, 4))
    origins = np.zeros((len(q), 3))
    directions = np.zeros((len(q), 3))
    k = 0
    for i in range(len(parents)):
        T = Ts[i]
        if parents[i] < 0:
            _copy(T_parent_link0[i], T)
        else:
            _multiply(Ts[parents[i]], T_parent_link0[i], T)
        for _ in range(n_axes[i]):
            a = axis_directions[k]
            for row in range(3):
                origins[k, row] = T[row, 3]
                directions[k, row] = T[row, 0] * a[0] + T[row, 1] * a[1] + T[row, 2] * a[2]
            if prismatic[k]:
                for row in range(3):
                    T[row, 3] += directions[k, row] * q[k]
            else:
                _turn(T, a, q[k])
            k += 1
    return Ts, origins, directions


# Spelt-out loops over so few numbers run faster than library calls, and slices take long to compile.
@compiled
def _copy(A: Array, out: Array) -> None:
    for i in range(4):
        for j in range(4):
            out[i, j] = A[i, j]


@compiled
def _multiply(A: Array, B: Array, out: Array) -> None:
    """Computes out = A B for (4, 4) matrices."""
    for i in range(4):
        for j in range(4):
            out[i, j] = A[i, 0] * B[0, j] + A[i, 1] * B[1, j] + A[i, 2] * B[2, j] + A[i, 3] * B[3, j]


@compiled
def _turn(T: Array, axis: Array, angle: float) -> None:
    """T <- T (rotation by `angle` about the unit vector `axis` through the origin), in place."""
    s, c = np.sin(angle), np.cos(angle)
    x, y, z = axis[0], axis[1], axis[2]
    v = 1.0 - c
    for row in range(3):
        a, b, d = T[row, 0], T[row, 1], T[row, 2]
        T[row, 0] = a * (c + x * x * v) + b * (x * y * v + z * s) + d * (x * z * v - y * s)
        T[row, 1] = a * (x * y * v - z * s) + b * (c + y * y * v) + d * (y * z * v + x * s)
        T[row, 2] = a * (x * z * v + y * s) + b * (y * z * v - x * s) + d * (c + z * z * v)


@compiled
def _jacobian(
    moves: NDArray[np.bool_], prismatic: NDArray[np.bool_], origins: Array, directions: Array, p: Array
) -> tuple[Array, Array]:
    J_p = np.zeros((3, len(moves)))
    J_w = np.zeros((3, len(moves)))
    for k in range(len(moves)):
        if not moves[k]:
            continue
        d0, d1, d2 = directions[k, 0], directions[k, 1], directions[k, 2]
        if prismatic[k]:
            J_p[0, k], J_p[1, k], J_p[2, k] = d0, d1, d2
            continue
        x, y, z = p[0] - origins[k, 0], p[1] - origins[k, 1], p[2] - origins[k, 2]
        J_p[0, k], J_p[1, k], J_p[2, k] = d1 * z - d2 * y, d2 * x - d0 * z, d0 * y - d1 * x
        J_w[0, k], J_w[1, k], J_w[2, k] = d0, d1, d2
    return J_p, J_w
