"""DexGraspNet and UniDexGrasp: dictionaries of joints by name, position and Euler angles of the wrist."""

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
    Question,
    WrittenObject,
    WrittenPose,
    questions,
)
from .values import MOST_GRASPS, as_numbers, as_scale, as_text, named_numbers, required, scalars

__all__ = ["is_dexgraspnet", "read_dexgraspnet"]

FORMAT = "dexgraspnet"
_POSITION = ("WRJTx", "WRJTy", "WRJTz")
_EULER = ("WRJRx", "WRJRy", "WRJRz")
_MOST_JOINTS = 64
_NORM_TOLERANCE = 1e-3


def is_dexgraspnet(data: Any) -> bool:
    """Whether a file's content is such dictionaries, one or many."""
    entries = _entries(data)
    return bool(entries) and isinstance(entries[0], Mapping) and "qpos" in entries[0]


def read_dexgraspnet(data: Any, path: Path) -> GraspFile:
    """The grasps of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    entries = _entries(data)
    if len(entries) > MOST_GRASPS:
        raise InputError(path, "", f"has {len(entries)} grasps; at most {MOST_GRASPS} are read at once")
    is_uni = isinstance(data, Mapping) and "plane" in data
    # UniDexGrasp has a file for each grasp, in a folder that has the object's name.
    name = path.absolute().parent.name if is_uni else path.stem
    grasps = tuple(_grasp(i, entry, name, path) for i, entry in enumerate(entries))
    has_names = all(grasp.grasp.joints is None or grasp.grasp.joints.names for grasp in grasps)
    has_quaternion = any(grasp.grasp.pose and grasp.grasp.pose.quaternion is not None for grasp in grasps)
    return GraspFile(
        path,
        FORMAT,
        "UniDexGrasp: one grasp with the plane that it stands on" if is_uni else "a list of dictionaries",
        grasps,
        (
            *questions(length="m", angle="rad", frame="base", direction="hand_in_object"),
            *_scale_question(grasps),
            *(() if has_names else questions(joint_order=None)),
            *(questions(quaternion="wxyz") if has_quaternion else ()),
        ),
        {},
        tuple(_remarks(entries, name, grasps)),
    )


def _entries(data: Any) -> list[Any]:
    if isinstance(data, np.ndarray) and data.dtype == object:
        return list(data.ravel())
    return data if isinstance(data, list) else [data]


def _grasp(i: int, entry: Any, name: str, path: Path) -> Grasp:
    if not isinstance(entry, Mapping):
        raise InputError(path, str(i), "must be a dictionary with qpos and scale")
    written = required(entry, "qpos", path, str(i))
    if isinstance(written, np.ndarray) and written.dtype == object and written.size == 1:
        written = written.reshape(()).item()
    field = f"{i}.qpos"
    posture = (
        _by_name(written, path, field) if isinstance(written, Mapping) else _in_a_row(written, path, field)
    )
    return Grasp(
        str(i),
        posture,
        object=WrittenObject(
            name=as_text(entry.get("object_code"), path, f"{i}.object_code") or name,
            scale=as_scale(entry.get("scale"), path, f"{i}.scale"),
        ),
        labels=dict(scalars(entry, ("scale", "object_code"))),
        numbers=_plane(entry, path, i),
    )


def _plane(entry: Mapping[str, Any], path: Path, i: int) -> dict[str, tuple[float, ...]]:
    if entry.get("plane") is None:
        return {}
    return {"plane": tuple(as_numbers(entry["plane"], (4,), path, f"{i}.plane").tolist())}


def _by_name(written: Mapping[str, Any], path: Path, field: str) -> Posture:
    values = named_numbers(written, path, field)
    missing = [name for name in (*_POSITION, *_EULER) if name not in values]
    if missing:
        raise InputError(path, f"{field}.{missing[0]}", "is required: position and Euler angles of the wrist")
    position = np.array([values.pop(name) for name in _POSITION])
    euler = np.array([values.pop(name) for name in _EULER])
    joints = JointValues(np.array(list(values.values())), tuple(values))
    return Posture(WrittenPose(position=position, euler=euler), joints)


def _in_a_row(written: Any, path: Path, field: str) -> Posture:
    """A pose and joints in one array: with a quaternion, Euler angles, or two columns of a matrix."""
    row = as_numbers(written, (None,), path, field)
    if not 7 <= len(row) <= 9 + _MOST_JOINTS:
        raise InputError(path, field, f"must be joints by name, or a pose and joints, not {len(row)} numbers")
    if abs(np.linalg.norm(row[3:7]) - 1.0) < _NORM_TOLERANCE:
        return Posture(WrittenPose(position=row[:3], quaternion=row[3:7]), JointValues(row[7:]))
    if len(row) >= 9 and (rotation := _from_two_columns(row[3:9])) is not None:
        return Posture(WrittenPose(position=row[:3], rotation=rotation), JointValues(row[9:]))
    return Posture(WrittenPose(position=row[:3], euler=row[3:6]), JointValues(row[6:]))


def _from_two_columns(six: Array) -> Array | None:
    """The rotation whose first two columns are written; None where they are no such columns."""
    x, y = six[:3], six[3:]
    if max(abs(x @ x - 1.0), abs(y @ y - 1.0), abs(x @ y)) > _NORM_TOLERANCE:
        return None
    return np.column_stack([x, y, np.cross(x, y)])


def _scale_question(grasps: tuple[Grasp, ...]) -> tuple[Question, ...]:
    """Whether scales multiply or divide: the size in DexGraspNet (0.08), its inverse in UniDexGrasp."""
    scales = [grasp.object.scale[0] for grasp in grasps if grasp.object.scale is not None]
    if not scales:
        return ()
    usual = "divided" if min(scales) > 1.0 else "times"
    stated = f"scales from {min(scales):.4g} to {max(scales):.4g} of a mesh of about 1"
    return (Question.of("scale", usual, stated),)


def _remarks(entries: list[Any], name: str, grasps: tuple[Grasp, ...]) -> list[str]:
    remarks = []
    if not any("object_code" in entry for entry in entries):
        remarks.append(f"its object is named by the path alone, as {name!r}")
    if any("qpos_st" in entry for entry in entries):
        remarks.append("qpos_st, where its authors' search began, is left aside")
    if any(grasp.object.scale is None for grasp in grasps):
        remarks.append("it has no scale of the object")
    return remarks
