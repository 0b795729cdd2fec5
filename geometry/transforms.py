"""Rotations and poses as plain arrays; quaternions are (w, x, y, z)."""

from math import sqrt

import numpy as np

from ..base.numeric.arrays import Array

__all__ = [
    "axis_rotation",
    "invert",
    "perpendicular",
    "pose",
    "quaternion_from_rotation",
    "rotation_angle",
    "rotation_exp",
    "rotation_from_quaternion",
    "rotation_from_unit_quaternion",
    "skew",
    "transform_points",
]


def skew(v: Array) -> Array:
    """Returns the (3, 3) matrix with `skew(v) @ x == cross(v, x)`."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def axis_rotation(axis: Array, angle_rad: float) -> Array:
    """Rotation (3, 3) by `angle_rad` about the unit vector `axis` (Rodrigues)."""
    K = skew(axis)
    return np.eye(3) + np.sin(angle_rad) * K + (1.0 - np.cos(angle_rad)) * (K @ K)


def rotation_exp(w: Array) -> Array:
    """Rotation (3, 3) by the rotation vector `w` (3,), in rad."""
    angle = float(np.linalg.norm(w))
    if angle < 1e-12:
        return np.eye(3) + skew(w)
    return axis_rotation(w / angle, angle)


def rotation_angle(R: Array) -> float:
    """Angle in [0, pi] of a rotation; from sine and cosine, so that it is exact near 0 and pi."""
    sine = 0.5 * np.linalg.norm([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    return float(np.arctan2(sine, 0.5 * (np.trace(R) - 1.0)))


def pose(R: Array, p: Array) -> Array:
    """Homogeneous transform (4, 4) from a rotation and a position."""
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def transform_points(T: Array, points: Array) -> Array:
    """Points (..., 3) in the frame that the homogeneous transform `T` (4, 4) leads to."""
    return points @ T[:3, :3].T + T[:3, 3]


def invert(T: Array) -> Array:
    """Inverse of a homogeneous transform (4, 4)."""
    R = T[:3, :3].T
    return pose(R, -R @ T[:3, 3])


def quaternion_from_rotation(R: Array) -> Array:
    """Unit quaternion (w, x, y, z) with w >= 0 of a rotation (3, 3), by Shepperd's method."""
    m = np.array([np.trace(R), R[0, 0], R[1, 1], R[2, 2]])
    largest = int(np.argmax(m))
    q = np.empty(4)
    if largest == 0:
        q[:] = [1.0 + m[0], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    else:
        i, j, k = [(0, 1, 2), (1, 2, 0), (2, 0, 1)][largest - 1]
        q[0] = R[k, j] - R[j, k]
        q[1 + i] = 1.0 + R[i, i] - R[j, j] - R[k, k]
        q[1 + j] = R[j, i] + R[i, j]
        q[1 + k] = R[k, i] + R[i, k]
    q /= np.linalg.norm(q)
    return -q if q[0] < 0 else q


def rotation_from_quaternion(q: Array) -> Array:
    """Rotation (3, 3) of a quaternion (w, x, y, z), normalised first."""
    R = rotation_from_unit_quaternion(np.asarray(q, dtype=float) / np.linalg.norm(q))
    return np.ascontiguousarray(R)


def rotation_from_unit_quaternion(q: Array) -> Array:
    """Rotations (..., 3, 3) of unit quaternions (..., 4), each (w, x, y, z)."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    columns = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    return np.moveaxis(columns, (0, 1), (-1, -2))


def perpendicular(v: Array) -> Array:
    """Two unit vectors (2, 3) that make a right-handed frame with the unit vector `v`."""
    # Plain numbers: numpy takes thirty times as long over vectors that short.
    x, y, z = v.tolist()
    sizes = (abs(x), abs(y), abs(z))
    a, b, c = ((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))[sizes.index(min(sizes))]
    length = sqrt(a * a + b * b + c * c)
    a, b, c = a / length, b / length, c / length
    return np.array([[a, b, c], [y * c - z * b, z * a - x * c, x * b - y * a]])
