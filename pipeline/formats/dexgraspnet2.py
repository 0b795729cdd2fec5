"""DexGraspNet 2.0: columns of rotations, translations and each joint, for the grasps of a scene."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from .grasp_file import Grasp, GraspFile, JointValues, Posture, WrittenPose, questions
from .matrices import columns
from .values import MOST_GRASPS, as_numbers, check_rotations, required, shape_of

__all__ = ["is_dexgraspnet2", "read_dexgraspnet2"]

FORMAT = "dexgraspnet"
_POSE = ("translation", "rotation")
_JOINT = re.compile(r"j\d{1,3}")
_REMARKS = (
    "its poses are in the frame of the camera or scene, not of an object",
    "it names no object",
)


def is_dexgraspnet2(data: Any) -> bool:
    """Whether a file's content is such columns."""
    return isinstance(data, Mapping) and all(name in data for name in _POSE) and bool(_joint_names(data))


def read_dexgraspnet2(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file; the seed of each, in `point`, is kept among its numbers.

    Raises:
        InputError: naming the field and what is allowed.
    """
    count = (shape_of(data["translation"]) or (0,))[0]
    if not 0 < count <= MOST_GRASPS:
        raise InputError(path, "translation", f"must be 1 to {MOST_GRASPS} rows of 3 numbers")
    positions = as_numbers(data["translation"], (None, 3), path, "translation")
    rotations = as_numbers(required(data, "rotation", path), (count, 3, 3), path, "rotation")
    check_rotations(rotations, path, "rotation")
    names = _joint_names(data)
    joints = np.column_stack([as_numbers(data[name], (count,), path, name) for name in names])
    points = as_numbers(data["point"], (count, 3), path, "point") if "point" in data else None
    labels = columns(data, (*_POSE, *names, "point"), count, path, "")
    grasps = tuple(
        Grasp(
            str(i),
            Posture(
                WrittenPose(position=positions[i], rotation=rotations[i]),
                JointValues(joints[i], tuple(names)),
            ),
            labels={name: values[i] for name, values in labels.items()},
            numbers={} if points is None else {"point": tuple(points[i].tolist())},
        )
        for i in range(count)
    )
    open_ones = questions(length="m", angle="rad", frame="base", direction="hand_in_object")
    return GraspFile(path, FORMAT, "DexGraspNet 2.0: columns of a scene", grasps, open_ones, {}, _REMARKS)


def _joint_names(data: Mapping[Any, Any]) -> list[str]:
    """Names of joints among the columns, by their numbers."""
    found = [name for name in data if isinstance(name, str) and _JOINT.fullmatch(name)]
    return sorted(found, key=lambda name: int(name[1:]))
