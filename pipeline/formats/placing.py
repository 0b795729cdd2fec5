"""What a file's numbers mean in one reading of them: poses of the hand in the object's frame, in metres."""

from collections.abc import Mapping

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import axis_rotation, rotation_from_quaternion
from .grasp_file import Grasp, Posture, QuestionName, WrittenPose

__all__ = ["fixed_axes", "hand_in_object", "object_factor", "to_matrix"]

_METRES = {"m": 1.0, "mm": 1e-3}
_RADIANS = {"rad": 1.0, "deg": np.pi / 180.0}


def to_matrix(pose: WrittenPose, reading: Mapping[QuestionName, str]) -> Array:
    """The homogeneous matrix (4, 4) of a pose, in m.

    Args:
        pose: as written.
        reading: answers to `quaternion`, `length` and `angle`; without one it is w first, m, rad.
    """
    T = np.eye(4)
    if pose.matrix is not None:
        T[:3] = pose.matrix[:3]
    else:
        T[:3, :3] = _rotation(pose, reading)
        if pose.position is not None:
            T[:3, 3] = pose.position
    T[:3, 3] *= _METRES[reading.get("length", "m")]
    return T


def _rotation(pose: WrittenPose, reading: Mapping[QuestionName, str]) -> Array:
    if pose.rotation is not None:
        return pose.rotation
    if pose.quaternion is not None:
        is_last = reading.get("quaternion", "wxyz") == "xyzw"
        quaternion = np.roll(pose.quaternion, 1) if is_last else pose.quaternion
        return rotation_from_quaternion(quaternion)
    if pose.euler is not None:
        return fixed_axes(pose.euler * _RADIANS[reading.get("angle", "rad")])
    return np.eye(3)


def fixed_axes(angles_rad: Array) -> Array:
    """The rotation (3, 3) of turns about the fixed axes x, then y, then z."""
    x, y, z = (axis_rotation(axis, angle) for axis, angle in zip(np.eye(3), angles_rad, strict=True))
    return z @ y @ x


def hand_in_object(
    grasp: Grasp, reading: Mapping[QuestionName, str], posture: Posture | None = None
) -> Array:
    """The pose (4, 4) of the hand's frame in the object's, in m; which frame that is, `frame` says.

    Args:
        grasp: of the file.
        reading: answers to the questions of the file.
        posture: the pregrasp or squeeze instead of the grasp.
    """
    pose = (posture or grasp.grasp).pose or grasp.grasp.pose
    T = np.eye(4) if pose is None else to_matrix(pose, reading)
    if grasp.object_pose is not None:
        return np.asarray(np.linalg.solve(to_matrix(grasp.object_pose, reading), T), dtype=float)
    if reading.get("direction") == "object_in_hand":
        return np.asarray(np.linalg.inv(T), dtype=float)
    return T


def object_factor(grasp: Grasp, reading: Mapping[QuestionName, str]) -> Array:
    """What the object's mesh is multiplied by along x, y, z (3,)."""
    factor = np.ones(3) * (1.0 if grasp.object.scale is None else np.array(grasp.object.scale))
    return 1.0 / factor if reading.get("scale") == "divided" else factor
