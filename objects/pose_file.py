"""Where a body lies, as it stands in files."""

import numpy as np

from ..base.files.fields import Finite, Vector3
from ..base.files.file_model import FileModel
from ..base.numeric.arrays import Array
from ..errors import InputError
from ..geometry import pose, rotation_from_quaternion

__all__ = ["PoseSpec", "build_pose"]


class PoseSpec(FileModel):
    """Where one frame lies in another: its origin in m, and its turn as a quaternion w, x, y, z."""

    position: Vector3 = (0.0, 0.0, 0.0)
    quaternion: tuple[Finite, Finite, Finite, Finite] = (1.0, 0.0, 0.0, 0.0)


def build_pose(spec: PoseSpec, source: str, field: str) -> Array:
    """The pose as a matrix (4, 4).

    Raises:
        InputError: a quaternion that is not of unit length.
    """
    quaternion = np.array(spec.quaternion)
    if abs(float(np.linalg.norm(quaternion)) - 1.0) > 1e-3:
        raise InputError(source, f"{field}.quaternion", "must have length 1 (w, x, y, z)")
    return pose(rotation_from_quaternion(quaternion), np.array(spec.position))
