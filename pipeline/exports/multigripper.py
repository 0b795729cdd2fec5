"""MultiGripperGrasp JSON."""

import json
from collections.abc import Sequence
from typing import Any

from ...errors import InputError
from ...geometry import quaternion_from_rotation
from .placed import PlacedGrasp, one_object

__all__ = ["multigripper_bytes"]


def multigripper_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The text of a file: rows of position and quaternion (w first), of joints, and `result`.

    Raises:
        InputError: the grasps are of several objects or hands, there are none, or their object has a scale,
            which the format has no place for.
    """
    first = one_object(grasps, "multigrippergrasp")
    if abs(first.scale - 1.0) > 1e-9:
        raise InputError("export", "multigrippergrasp", "has no place for the scale of an object")
    data: dict[str, Any] = {
        "gripper": first.hand,
        "object_id": first.object,
        "pose": [[*grasp.T_object_hand[:3, 3].tolist(), *_quaternion(grasp)] for grasp in grasps],
        "dofs": [list(grasp.joints.values()) for grasp in grasps],
        "dof_names": list(first.joints),
    }
    if all(grasp.holds is not None for grasp in grasps):
        data["result"] = [int(bool(grasp.holds)) for grasp in grasps]
    return (json.dumps(data, indent=1, allow_nan=False) + "\n").encode("utf-8")


def _quaternion(grasp: PlacedGrasp) -> list[float]:
    values: list[float] = quaternion_from_rotation(grasp.T_object_hand[:3, :3]).tolist()
    return values
