"""Our own grasps: `grasps/<id>.json`, and the `run.json` of a run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...base.files.input_file import open_input
from ...base.files.json_file import read_json_value
from ..records import GraspRecord, read_grasp, read_run
from .grasp_file import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    QuestionName,
    WrittenHand,
    WrittenObject,
    WrittenPose,
)

__all__ = ["is_own", "is_own_file", "read_own"]

FORMAT = "holdfast"
SETTLED: dict[QuestionName, str] = {
    "quaternion": "wxyz",
    "length": "m",
    "angle": "rad",
    "joint_length": "m",
    "frame": "base",
    "direction": "object_in_hand",
}
"""What holds of every grasp of ours: poses of the object in the palm's frame."""


def is_own(data: Any) -> bool:
    """Whether a file says that we wrote it."""
    return isinstance(data, Mapping) and "holdfast" in data and "task_source" in data


def is_own_file(path: Path) -> bool:
    """Whether a file is JSON that we wrote.

    Raises:
        InputError: it can't be read.
    """
    with open_input(path) as file:
        if file.read(64).lstrip()[:1] != b"{":
            return False
    return is_own(read_json_value(path, not_numbers=True))


def read_own(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file or a run.

    Raises:
        InputError: naming the field and what is allowed.
    """
    if "grasps" in data:
        run = read_run(path)
        hand, object_ = WrittenHand(run.hand, frame="palm"), WrittenObject(run.object)
        grasps = tuple(_grasp(record, hand, object_) for record in run.grasps)
        return GraspFile(path, FORMAT, "run", grasps, (), SETTLED)
    record = read_grasp(path)
    hand, object_ = WrittenHand(record.hand, frame="palm"), WrittenObject(record.object_name)
    return GraspFile(path, FORMAT, "grasp", (_grasp(record, hand, object_),), (), SETTLED)


def _grasp(record: GraspRecord, hand: WrittenHand, object_: WrittenObject) -> Grasp:
    """A grasp of ours, as if another had written it."""
    before = record.approach.waypoints[0] if record.approach and record.approach.waypoints else None
    squeeze = None if record.hold is None else record.hold.squeeze
    labels: dict[str, float | bool] = {"certified": record.certified}
    if record.clearance is not None:
        labels["clear"] = record.is_clear
    if record.hold is not None:
        labels["held"] = record.is_held
    pose = WrittenPose(
        position=np.array(record.object.position, dtype=float),
        quaternion=np.array(record.object.quaternion, dtype=float),
    )
    return Grasp(
        record.id,
        Posture(pose, _joints(record.joints)),
        pregrasp=None if before is None else Posture(joints=_joints(before)),
        squeeze=None if squeeze is None else Posture(joints=_joints(squeeze.targets)),
        hand=hand,
        object=object_,
        labels=labels,
        contacts=tuple(contact.hand for contact in record.contacts) or None,
    )


def _joints(joints: Mapping[str, float]) -> JointValues:
    return JointValues(np.array(list(joints.values())), tuple(joints))
