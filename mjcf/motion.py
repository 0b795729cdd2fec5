"""How far an object has moved, from poses as MuJoCo keeps them: position, then quaternion (w, x, y, z)."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

__all__ = ["moved"]

Array = NDArray[np.float64]


def moved(poses: Array, reference: Array, watched: Array) -> tuple[Array, Array]:
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
    R = Rotation.from_quat(poses[whole, 3:], scalar_first=True)
    R0 = Rotation.from_quat(reference[3:], scalar_first=True)
    angle[whole] = (R * R0.inv()).magnitude()
    points = np.array(watched)  # SciPy wants them writable
    starts = R0.apply(points) + reference[:3]
    shifts = np.array([R.apply(p) - start for p, start in zip(points, starts, strict=True)])
    slip[whole] = np.linalg.norm(shifts + poses[whole, :3], axis=2).max(axis=0)
    return slip, angle
