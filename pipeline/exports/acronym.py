"""ACRONYM HDF5."""

import io
from collections.abc import Sequence

import numpy as np

from ...base.machine.extras import from_extra
from .placed import PlacedGrasp, one_object

__all__ = ["acronym_bytes"]


def acronym_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The bytes of a file: matrices of the hand's root link in the object's frame, and who holds.

    Joints of each grasp stand in `grasps/configurations` (N, k), in the order of `gripper/joint_names`.

    Raises:
        InputError: the grasps are of several objects or hands, or there are none.
        MissingBackend: the package h5py is not installed.
    """
    h5py = from_extra("h5py", "formats", "writing HDF5")
    first = one_object(grasps, "acronym")
    buffer = io.BytesIO()
    # Equal grasps make equal files: no times in them.
    with h5py.File(buffer, "w", track_order=False) as file:
        file["object/file"] = first.object
        file["object/scale"] = first.scale
        file["gripper/type"] = first.hand
        file["grasps/transforms"] = np.array([grasp.T_object_hand for grasp in grasps])
        if first.joints:
            file["gripper/joint_names"] = list(first.joints)
            file["grasps/configurations"] = np.array([list(grasp.joints.values()) for grasp in grasps])
        if all(grasp.holds is not None for grasp in grasps):
            held = np.array([grasp.holds for grasp in grasps], dtype=np.int64)
            file["grasps/qualities/flex/object_in_gripper"] = held
    return buffer.getvalue()
