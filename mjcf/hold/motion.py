"""How far an object has moved, from poses as MuJoCo keeps them: position, then quaternion (w, x, y, z)."""

import numpy as np

from ...arrays import Array
from ...geometry import rotation_from_unit_quaternion

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
    slip, angle = np.full(len(poses), np.nan), np.full(len(poses), np.nan)
    whole = np.isfinite(poses).all(axis=1)
    if not whole.any() or not np.isfinite(reference).all():
        return slip, angle
    q, q0 = poses[whole, 3:], reference[3:]
    q, q0 = q / np.linalg.norm(q, axis=1, keepdims=True), q0 / np.linalg.norm(q0)
    # The relative rotation q q0^-1; |w| makes the angle that of the shorter way, whatever the signs.
    w = q @ q0
    u, u0 = q[:, 1:], q0[1:]
    v = q0[0] * u - q[:, :1] * u0 - (u[:, [1, 2, 0]] * u0[[2, 0, 1]] - u[:, [2, 0, 1]] * u0[[1, 2, 0]])
    angle[whole] = 2.0 * np.arctan2(np.linalg.norm(v, axis=1), np.abs(w))
    paths = _placed(poses[whole], q, watched) - _placed(reference[None], q0[None], watched)
    slip[whole] = np.sqrt((paths * paths).sum(axis=2).max(axis=1))
    return slip, angle


def _placed(poses: Array, q: Array, points: Array) -> Array:
    """Points (n, 3) of a body at poses (k, 7) with unit quaternions (k, 4), as (k, n, 3)."""
    R = rotation_from_unit_quaternion(q)
    return points @ R.transpose(0, 2, 1) + poses[:, None, :3]
