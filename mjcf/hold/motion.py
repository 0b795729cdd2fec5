"""How far an object has moved, from poses as MuJoCo keeps them: position, then quaternion (w, x, y, z)."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array

__all__ = ["slip_and_rotation"]


def slip_and_rotation(poses: Array, reference: Array, watched: Array) -> tuple[Array, Array]:
    """Displacement and rotation of a body.

    Args:
        poses: (k, 7) poses of the body.
        reference: (7,) the pose that they are compared with.
        watched: (n, 3) points in the body's frame, in m.

    Returns:
        Largest displacement (k,) of the points in m and angle (k,) in rad, in [0, pi]: q and -q are the same
        rotation. Both are NaN where a pose is not finite.
    """
    out = np.full((2, len(poses)), np.nan)
    poses, reference, watched = (np.ascontiguousarray(given) for given in (poses, reference, watched))
    _move(poses, reference, watched, out)
    return out[0], out[1]


@compiled
def _move(poses: Array, reference: Array, watched: Array, out: Array) -> None:
    """Writes slip and rotation (2, k), and leaves them where a pose is not finite."""
    q0, q, place, place0 = np.empty(4), np.empty(4), np.empty(3), np.empty(3)
    if not _unit_quaternion(reference, q0):
        return
    for k in range(poses.shape[0]):
        pose = poses[k]
        if not _unit_quaternion(pose, q):
            continue
        # The relative rotation q q0^-1; |w| makes the angle that of the shorter way, whatever the signs.
        w = q[0] * q0[0] + q[1] * q0[1] + q[2] * q0[2] + q[3] * q0[3]
        x = q0[0] * q[1] - q[0] * q0[1] - (q[2] * q0[3] - q[3] * q0[2])
        y = q0[0] * q[2] - q[0] * q0[2] - (q[3] * q0[1] - q[1] * q0[3])
        z = q0[0] * q[3] - q[0] * q0[3] - (q[1] * q0[2] - q[2] * q0[1])
        farthest = 0.0
        for j in range(watched.shape[0]):
            _turn(q, watched[j], place)
            _turn(q0, watched[j], place0)
            way = 0.0
            for i in range(3):
                way += (place[i] - place0[i] + pose[i] - reference[i]) ** 2
            farthest = max(farthest, way)
        out[0, k] = np.sqrt(farthest)
        out[1, k] = 2.0 * np.arctan2(np.sqrt(x * x + y * y + z * z), abs(w))


@compiled
def _unit_quaternion(pose: Array, out: Array) -> bool:
    """Writes the quaternion (4,) of a pose (7,) with length 1; False where the pose is not finite."""
    square = 0.0
    for i in range(7):
        if not np.isfinite(pose[i]):
            return False
        if i > 2:
            square += pose[i] * pose[i]
    length = np.sqrt(square)
    for i in range(4):
        out[i] = pose[3 + i] / length
    return True


@compiled
def _turn(q: Array, point: Array, out: Array) -> None:
    """Writes a point (3,) turned by a unit quaternion (4,)."""
    # p + w u + v x u with u = 2 v x p
    a = 2.0 * (q[2] * point[2] - q[3] * point[1])
    b = 2.0 * (q[3] * point[0] - q[1] * point[2])
    c = 2.0 * (q[1] * point[1] - q[2] * point[0])
    out[0] = point[0] + q[0] * a + q[2] * c - q[3] * b
    out[1] = point[1] + q[0] * b + q[3] * a - q[1] * c
    out[2] = point[2] + q[0] * c + q[1] * b - q[2] * a
