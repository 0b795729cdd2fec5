"""isaac_grasp YAML: poses of a gripper in an object's frame, with joints by name."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from .grasp_file import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    WrittenHand,
    WrittenObject,
    WrittenPose,
    questions,
)
from .values import (
    MOST_GRASPS,
    as_label,
    as_number,
    as_numbers,
    as_quaternions,
    as_scale,
    as_text,
    named_numbers,
    required,
)

__all__ = ["is_isaac_grasp", "read_isaac_grasp"]

FORMAT = "isaac_grasp"


def is_isaac_grasp(data: Any) -> bool:
    """Whether a file's fields are those of this format, be its name there or not."""
    if not isinstance(data, Mapping):
        return False
    if data.get("format") == FORMAT:
        return True
    grasps = data.get("grasps")
    entries = list(_entries(grasps).values())[:1]
    return (
        bool(entries) and isinstance(entries[0], Mapping) and {"position", "orientation"} <= set(entries[0])
    )


def read_isaac_grasp(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    entries = _entries(required(data, "grasps", path))
    if not entries:
        raise InputError(path, "grasps", "must hold at least one grasp, by name")
    if len(entries) > MOST_GRASPS:
        raise InputError(path, "grasps", f"has {len(entries)} grasps; at most {MOST_GRASPS} are read at once")
    object_, hand = _object(data, path), _hand(data, path)
    is_named = not any(map(_is_in_a_row, entries.values()))
    grasps = tuple(_grasp(name, entry, object_, hand, path) for name, entry in entries.items())
    return GraspFile(
        path,
        FORMAT,
        _variant(data),
        grasps,
        questions(
            **({} if is_named else {"quaternion": None}),
            length="m",
            angle="rad",
            joint_length="m",
            frame="base",
            direction="hand_in_object",
            **({} if object_.scale is None else {"scale": "times"}),
        ),
        {"quaternion": "wxyz"} if is_named else {},
        tuple(_remarks(data, grasps)),
    )


def _entries(grasps: Any) -> dict[str, Any]:
    if isinstance(grasps, Mapping):
        return dict(grasps)
    return {f"grasp_{i}": entry for i, entry in enumerate(grasps)} if isinstance(grasps, list) else {}


def _variant(data: Mapping[str, Any]) -> str:
    for suffix in ("frame_link", "frame"):
        if f"object_{suffix}" in data or f"gripper_{suffix}" in data:
            return f"with object_{suffix} and gripper_{suffix}"
    return "without frames"


def _object(data: Mapping[str, Any], path: Path) -> WrittenObject:
    return WrittenObject(
        path=as_text(data.get("object_file"), path, "object_file"),
        scale=as_scale(data.get("object_scale"), path, "object_scale"),
        frame=_frame(data, "object", path),
    )


def _hand(data: Mapping[str, Any], path: Path) -> WrittenHand:
    numbers: dict[str, float | tuple[float, ...]] = {
        name: as_number(data[name], path, name)
        for name in ("base_length", "approach_axis", "bite_body_idx")
        if data.get(name) is not None
    }
    if data.get("bite_point") is not None:
        numbers["bite_point"] = tuple(as_numbers(data["bite_point"], (3,), path, "bite_point").tolist())
    return WrittenHand(
        path=as_text(data.get("gripper_file"), path, "gripper_file"),
        frame=_frame(data, "gripper", path),
        numbers=numbers,
    )


def _frame(data: Mapping[str, Any], whose: str, path: Path) -> str:
    name = f"{whose}_frame_link" if f"{whose}_frame_link" in data else f"{whose}_frame"
    return as_text(data.get(name), path, name)


def _grasp(name: str, entry: Any, object_: WrittenObject, hand: WrittenHand, path: Path) -> Grasp:
    field = f"grasps.{name}"
    if not isinstance(entry, Mapping):
        raise InputError(path, field, "must hold position and orientation")
    quaternion = _quaternion(required(entry, "orientation", path, field), path, f"{field}.orientation")
    position = as_numbers(required(entry, "position", path, field), (3,), path, f"{field}.position")
    before = _joints(entry, "pregrasp_cspace_position", path, field)
    confidence = entry.get("confidence")
    return Grasp(
        name,
        Posture(
            WrittenPose(position=position, quaternion=quaternion),
            _joints(entry, "cspace_position", path, field),
        ),
        pregrasp=None if before is None else Posture(joints=before),
        hand=hand,
        object=object_,
        labels={}
        if confidence is None
        else {"confidence": as_label(confidence, path, f"{field}.confidence")},
        numbers={
            point: tuple(as_numbers(entry[point], (3,), path, f"{field}.{point}").tolist())
            for point in ("bite_point", "pregrasp_bite_point")
            if entry.get(point) is not None
        },
    )


def _is_in_a_row(entry: Any) -> bool:
    return isinstance(entry, Mapping) and isinstance(entry.get("orientation"), list)


def _quaternion(written: Any, path: Path, field: str) -> Array:
    """Four numbers, w first where they are named; some programs write them in a row."""
    if isinstance(written, list):
        return as_quaternions([written], path, field)[0]
    if not isinstance(written, Mapping):
        raise InputError(path, field, "must be {w: ..., xyz: [...]}")
    w = as_number(required(written, "w", path, field), path, f"{field}.w")
    xyz = as_numbers(required(written, "xyz", path, field), (3,), path, f"{field}.xyz")
    return as_quaternions([[w, *xyz.tolist()]], path, field)[0]


def _joints(entry: Mapping[str, Any], name: str, path: Path, field: str) -> JointValues | None:
    if not entry.get(name):
        return None
    values = named_numbers(entry[name], path, f"{field}.{name}")
    return JointValues(np.array(list(values.values())), tuple(values))


def _remarks(data: Mapping[str, Any], grasps: tuple[Grasp, ...]) -> list[str]:
    remarks = []
    if data.get("format") != FORMAT:
        remarks.append("its field format does not say isaac_grasp")
    if "format_version" not in data:
        remarks.append("it has no format_version")
    if all(grasp.grasp.joints is None for grasp in grasps):
        has_before = any(grasp.pregrasp is not None for grasp in grasps)
        remarks.append(
            "it has joints of the pregrasp alone"
            if has_before
            else "it has no joints, only poses of the gripper"
        )
    if not any(grasp.labels for grasp in grasps):
        remarks.append("it has no confidence, which counts as 1")
    return remarks
