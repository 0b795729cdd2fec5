"""MultiGripperGrasp JSON: columns of poses, joint values and results, as lists or keyed by row."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

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
from .values import MOST_GRASPS, as_label, as_numbers, as_quaternions, as_text, required

__all__ = ["is_multigripper", "read_multigripper"]

FORMAT = "multigrippergrasp"
_OBJECTS = ("object_id", "object_ID", "object")
_BESIDE = ("gripper", "dofs", "final_dofs", "fall_time", "result", *_OBJECTS)
_LABELS = ("result", "fall_time", "result_time", "slip_time", "standing_time")
_MOST_JOINTS = 64


def is_multigripper(data: Any) -> bool:
    """Whether a file's fields are those of this format."""
    return isinstance(data, Mapping) and (_is_table(data) or _is_by_gripper(data))


def _is_table(data: Any) -> bool:
    return isinstance(data, Mapping) and "pose" in data and any(name in data for name in _BESIDE)


def _is_by_gripper(data: Mapping[str, Any]) -> bool:
    """Whether it holds a table for each of several grippers."""
    tables = [isinstance(value, Mapping) and "pose" in value for value in data.values()]
    return bool(tables) and all(tables)


def read_multigripper(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    if not _is_table(data):
        return _by_gripper(data, path)
    rows = _rows(required(data, "pose", path), path, "pose")
    keys = list(rows)
    poses = as_numbers(list(rows.values()), (None, 7), path, "pose")
    as_quaternions(poses[:, 3:], path, "pose")
    columns = {
        name: _column(data[name], keys, path, name)
        for name in ("dofs", "final_dofs", *_LABELS)
        if data.get(name) is not None
    }
    joints = "dofs" if "dofs" in columns else "final_dofs"
    objects, hands = _names(data, _OBJECTS, keys, path), _names(data, ("gripper",), keys, path)
    hand_of = {name: WrittenHand(name=name) for name in set(hands)}
    object_of = {name: WrittenObject(name=name) for name in set(objects)}
    grasps = tuple(
        Grasp(
            key,
            Posture(
                WrittenPose(position=poses[i, :3], quaternion=poses[i, 3:]),
                _joints(columns.get(joints), i, path, f"{joints}.{key}"),
            ),
            hand=hand_of[hands[i]],
            object=object_of[objects[i]],
            labels={
                name: as_label(columns[name][i], path, f"{name}.{key}") for name in _LABELS if name in columns
            },
            numbers=_final(columns.get("final_dofs"), i, path, f"final_dofs.{key}"),
        )
        for i, key in enumerate(keys)
    )
    return GraspFile(
        path,
        FORMAT,
        "columns keyed by row" if isinstance(data["pose"], Mapping) else "columns as lists",
        grasps,
        questions(
            quaternion="wxyz",
            length="m",
            angle="rad",
            joint_length="m",
            frame="base",
            direction="hand_in_object",
            **({"joint_order": None} if joints in columns else {}),
        ),
        {},
        tuple(_remarks(columns, len(hand_of))),
    )


def _by_gripper(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file with a table for each gripper, named by it."""
    files = {
        name: read_multigripper({"gripper": name, **table}, path) for name, table in list(data.items())[:1000]
    }
    grasps = [
        replace(grasp, name=f"{name}/{grasp.name}") for name, file in files.items() for grasp in file.grasps
    ]
    if len(files) < len(data) or len(grasps) > MOST_GRASPS:
        raise InputError(path, "", f"holds more than 1000 grippers or {MOST_GRASPS} grasps")
    first = next(iter(files.values()))
    asked = {question.name: question for file in files.values() for question in file.unsettled}
    remarks = dict.fromkeys(remark for file in files.values() for remark in file.remarks)
    return replace(
        first,
        variant="a table for each gripper",
        grasps=tuple(grasps),
        unsettled=tuple(asked.values()),
        remarks=tuple(remarks),
    )


def _rows(value: Any, path: Path, field: str) -> dict[str, Any]:
    """The rows of a column by their keys."""
    if isinstance(value, Mapping):
        rows = {str(key): row for key, row in value.items()}
    elif isinstance(value, list):
        if field == "pose" and value and len(value) % 7 == 0 and not isinstance(value[0], list):
            value = [value[i : i + 7] for i in range(0, len(value), 7)]
        rows = {str(i): row for i, row in enumerate(value)}
    else:
        raise InputError(path, field, "must be a list, or rows by key")
    if not 0 < len(rows) <= MOST_GRASPS:
        raise InputError(path, field, f"must hold between 1 and {MOST_GRASPS} rows")
    return rows


def _column(value: Any, keys: list[str], path: Path, field: str) -> list[Any]:
    rows = _rows(value, path, field)
    if list(rows) != keys and set(rows) != set(keys):
        raise InputError(path, field, f"must have the {len(keys)} rows that pose has, not {len(rows)}")
    return [rows[key] for key in keys]


def _names(data: Mapping[str, Any], fields: tuple[str, ...], keys: list[str], path: Path) -> list[str]:
    """A name for every row, from a field that holds one name or one for each."""
    field = next((field for field in fields if field in data), "")
    value = data.get(field)
    if isinstance(value, (Mapping, list)):
        return [as_text(name, path, field) for name in _column(value, keys, path, field)]
    return [as_text(value, path, field)] * len(keys)


def _joints(column: list[Any] | None, i: int, path: Path, field: str) -> JointValues | None:
    if column is None or column[i] is None:
        return None
    values = as_numbers(column[i], (None,), path, field)
    if len(values) > _MOST_JOINTS:
        raise InputError(path, field, f"has {len(values)} joints; at most {_MOST_JOINTS} are read")
    return JointValues(values)


def _final(column: list[Any] | None, i: int, path: Path, field: str) -> dict[str, tuple[float, ...]]:
    joints = _joints(column, i, path, field)
    return {} if joints is None else {"final_dofs": tuple(joints.values.tolist())}


def _remarks(columns: Mapping[str, Any], hands: int) -> list[str]:
    remarks = []
    if hands > 1:
        remarks.append(f"it holds grasps of {hands} grippers")
    if "final_dofs" in columns and "dofs" not in columns:
        remarks.append("its joints are those at the end of closing, final_dofs")
    if "fall_time" in columns:
        remarks.append(
            "fall_time is the whole length of the test where the object was held, 0 where not tested"
        )
    return remarks
