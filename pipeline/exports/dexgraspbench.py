"""DexGraspBench .npy: a dictionary a grasp."""

import io
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import quaternion_from_rotation
from .placed import PlacedGrasp

__all__ = ["dexgraspbench_bytes"]


def dexgraspbench_bytes(grasp: PlacedGrasp) -> bytes:
    """The bytes of a file: position, quaternion (w first) and joints at each moment, object at the origin.

    The joints stand in the order of `joint_names`, which is the hand's. Where no pregrasp or squeeze is
    known its row is that of the grasp, for the format asks for all three.

    Raises:
        InputError: the grasp has no joints.
    """
    if not grasp.joints:
        raise InputError(
            "export", "dexgraspbench", f"grasp {grasp.name} has no joints, which the format asks for"
        )
    data: dict[str, Any] = {
        "obj_pose": np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        "obj_scale": grasp.scale,
        "obj_path": grasp.object,
        "pregrasp_qpos": _row(grasp, grasp.pregrasp),
        "grasp_qpos": _row(grasp, grasp.joints),
        "squeeze_qpos": _row(grasp, grasp.squeeze),
        "joint_names": list(grasp.joints),
        "hand_name": grasp.hand,
    }
    if grasp.holds is not None:
        data["succ_flag"] = grasp.holds
    buffer = io.BytesIO()
    # The format is numpy's own way to save a dictionary; what it holds is arrays, numbers and text.
    np.save(buffer, np.array(data, dtype=object), allow_pickle=True)
    return buffer.getvalue()


def _row(grasp: PlacedGrasp, joints: Mapping[str, float] | None) -> Array:
    T = grasp.T_object_hand
    values = grasp.joints if joints is None else joints
    angles = [values.get(name, position) for name, position in grasp.joints.items()]
    return np.concatenate([T[:3, 3], quaternion_from_rotation(T[:3, :3]), angles])
