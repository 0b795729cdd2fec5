"""isaac_grasp YAML, as Isaac Sim's Grasp Editor and GraspDataGen write it."""

from collections.abc import Sequence
from typing import Any

import yaml

from ...geometry import quaternion_from_rotation
from .placed import PlacedGrasp, one_object

__all__ = ["isaac_grasp_bytes"]


def isaac_grasp_bytes(grasps: Sequence[PlacedGrasp]) -> bytes:
    """The text of a file: poses of the hand's root link in the object's frame, joints by name.

    `confidence` is 1 for grasps that hold, 0 for others that were tried, and is left out where that isn't
    known. The links are named as frames, with the object's file and scale beside them.

    Raises:
        InputError: the grasps are of several objects or hands, or there are none.
    """
    first = one_object(grasps, "isaac_grasp")
    data = {
        "format": "isaac_grasp",
        "format_version": "1.0",
        "object_frame_link": first.object,
        "gripper_frame_link": first.hand,
        "object_file": first.object,
        "object_scale": first.scale,
        "gripper_file": first.hand,
        "grasps": {grasp.name: _entry(grasp) for grasp in grasps},
    }
    return yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True).encode("utf-8")


def _entry(grasp: PlacedGrasp) -> dict[str, Any]:
    w, *xyz = quaternion_from_rotation(grasp.T_object_hand[:3, :3]).tolist()
    entry: dict[str, Any] = {} if grasp.holds is None else {"confidence": float(grasp.holds)}
    entry |= {
        "position": grasp.T_object_hand[:3, 3].tolist(),
        "orientation": {"w": w, "xyz": xyz},
        "cspace_position": dict(grasp.joints),
    }
    if grasp.pregrasp is not None:
        entry["pregrasp_cspace_position"] = dict(grasp.pregrasp)
    return entry


class _Dumper(yaml.CSafeDumper if hasattr(yaml, "CSafeDumper") else yaml.SafeDumper):  # type: ignore[misc]
    """A safe dumper that writes out what stands twice."""

    def ignore_aliases(self, data: Any) -> bool:
        return True
