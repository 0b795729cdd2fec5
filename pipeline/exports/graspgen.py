"""GraspGen JSON."""

import json
from collections.abc import Sequence
from typing import Any

from .placed import PlacedGrasp, one_object

__all__ = ["graspgen_bytes"]


def graspgen_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The text of a file: matrices of the hand's root link in the object's frame, and who holds.

    Joints, which the format has no place for, stand in `grasps.joint_positions` in the order of
    `gripper.joint_names`.

    Raises:
        InputError: the grasps are of several objects or hands, or there are none.
    """
    first = one_object(grasps, "graspgen")
    data: dict[str, Any] = {
        "object": {"file": first.object, "scale": first.scale},
        "gripper": {"name": first.hand, "joint_names": list(first.joints)},
        "grasps": {
            "transforms": [grasp.T_object_hand.tolist() for grasp in grasps],
            "joint_positions": [list(grasp.joints.values()) for grasp in grasps],
        },
    }
    # A mask says yes or no of every grasp; where some were not tried there is none.
    if all(grasp.holds is not None for grasp in grasps):
        data["grasps"]["object_in_gripper"] = [grasp.holds for grasp in grasps]
    return (json.dumps(data, indent=1, allow_nan=False) + "\n").encode("utf-8")
