"""DexGraspBench, BODex and Dexonomy: a dictionary of rows that hold position, quaternion and joints."""

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
from .matrices import columns
from .values import (
    MOST_GRASPS,
    as_names,
    as_numbers,
    as_quaternions,
    as_scale,
    as_text,
    required,
    scalars,
    shape_of,
)

__all__ = ["is_dexgraspbench", "read_dexgraspbench"]

FORMAT = "dexgraspbench"
_MOMENTS = ("pregrasp_qpos", "grasp_qpos", "squeeze_qpos")
_OTHERS = ("approach_qpos", "lift_qpos")
_OBJECT = (
    "obj_pose",
    "obj_scale",
    "obj_path",
    "scene_path",
    "scene_scale",
    "joint_names",
    "tmpl_name",
    "n_evo",
)
_MOST_NUMBERS = 128
_NORM_TOLERANCE = 1e-3


def is_dexgraspbench(data: Any) -> bool:
    """Whether a file's content is such a dictionary."""
    data = _mapping(data)
    return isinstance(data, Mapping) and ("grasp_qpos" in data or "robot_pose" in data)


def read_dexgraspbench(data: Any, path: Path) -> GraspFile:
    """The grasps of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    data = _mapping(data)
    remarks: list[str] = []
    is_bodex = "grasp_qpos" not in data
    moments = _bodex(data, path, remarks) if is_bodex else _moments(data, path, remarks)
    rows = moments["grasp_qpos"]
    has_pose = _has_pose(rows)
    if not has_pose:
        remarks.append("its rows hold no unit quaternion, so they are read as joints without a pose")
    names = _joint_names(data, rows.shape[1] - 7 * has_pose, path)
    postures = {moment: _postures(found, has_pose, names) for moment, found in moments.items()}
    hand = WrittenHand(name=as_text(data.get("hand_name"), path, "hand_name"))
    objects, pose = _objects(data, len(rows), path), _object_pose(data, len(rows), path)
    labels = _labels(data, len(rows), path)
    grasps = tuple(
        Grasp(
            str(i),
            postures["grasp_qpos"][i],
            pregrasp=postures["pregrasp_qpos"][i] if "pregrasp_qpos" in postures else None,
            squeeze=postures["squeeze_qpos"][i] if "squeeze_qpos" in postures else None,
            hand=hand,
            object=objects[i],
            object_pose=None if pose is None else pose[i],
            labels={name: values[i] for name, values in labels.items()},
        )
        for i in range(len(rows))
    )
    return GraspFile(
        path,
        FORMAT,
        _variant(data, is_bodex),
        grasps,
        questions(
            quaternion="wxyz",
            length="m",
            angle="rad",
            frame="base",
            **({"scale": "times"} if objects[0].scale else {}),
            **({} if pose is not None else {"direction": "hand_in_object"}),
            **({} if names else {"joint_order": None}),
        ),
        {},
        (*remarks, *_object_remarks(data)),
    )


def _mapping(data: Any) -> Any:
    return data.item() if isinstance(data, np.ndarray) and data.dtype == object and data.size == 1 else data


def _variant(data: Mapping[str, Any], is_bodex: bool) -> str:
    if is_bodex:
        return "BODex: robot_pose"
    if "tmpl_name" in data or "hand_cbody" in data:
        return "Dexonomy"
    return (
        "DexGraspBench" if len(shape_of(data["grasp_qpos"])) == 1 else "DexGraspBench, many grasps in a file"
    )


def _rows(value: Any, path: Path, field: str) -> Array:
    """One or more rows of numbers (N, L)."""
    rows = as_numbers([value] if len(shape_of(value)) == 1 else value, (None, None), path, field)
    if not 0 < len(rows) <= MOST_GRASPS or not 0 < rows.shape[1] <= _MOST_NUMBERS:
        raise InputError(path, field, f"must be 1 to {MOST_GRASPS} rows of 1 to {_MOST_NUMBERS} numbers")
    return rows


def _moments(data: Mapping[str, Any], path: Path, remarks: list[str]) -> dict[str, Array]:
    """The rows (N, L) of each moment that a file has."""
    rows = _rows(data["grasp_qpos"], path, "grasp_qpos")
    found = {"grasp_qpos": rows}
    for moment in _MOMENTS:
        if moment == "grasp_qpos" or data.get(moment) is None:
            continue
        others = _rows(data[moment], path, moment)
        if others.shape[1] != rows.shape[1]:
            raise InputError(path, moment, f"must have {rows.shape[1]} numbers a row, as grasp_qpos has")
        if len(others) != len(rows):
            if len(rows) > 1:
                raise InputError(path, moment, f"must have {len(rows)} rows, as grasp_qpos has")
            # Dexonomy writes the way from the open hand to the grasp.
            remarks.append(f"{moment} has {len(others)} rows for one grasp; the first is read")
            others = others[:1]
        found[moment] = others
    if left := [name for name in _OTHERS if name in data]:
        remarks.append(f"{' and '.join(left)}, motions before and after the grasp, are left aside")
    return found


def _bodex(data: Mapping[str, Any], path: Path, remarks: list[str]) -> dict[str, Array]:
    """The moments of robot_pose: (N, T, L) with any sides of 1 before, T the moments."""
    written = required(data, "robot_pose", path)
    while len(shape := shape_of(written)) > 3 and shape[0] == 1:
        written = written[0]
    if len(shape) < 3:
        return {"grasp_qpos": _rows(written, path, "robot_pose")}
    poses = as_numbers(written, (None, None, None), path, "robot_pose")
    count, moments, width = poses.shape
    if not (0 < count <= MOST_GRASPS and 0 < width <= _MOST_NUMBERS):
        raise InputError(path, "robot_pose", f"must hold 1 to {MOST_GRASPS} grasps")
    if moments == 3:
        return dict(zip(_MOMENTS, poses.transpose(1, 0, 2), strict=True))
    if moments > 3:
        remarks.append(
            f"robot_pose has {moments} moments; the last four are read as pregrasp, grasp, squeeze, lift"
        )
        return dict(zip(_MOMENTS, poses[:, -4:-1].transpose(1, 0, 2), strict=True))
    remarks.append("robot_pose has no squeeze; its last moment is read as the grasp")
    return {"grasp_qpos": poses[:, -1]}


def _has_pose(rows: Array) -> bool:
    if rows.shape[1] < 7:
        return False
    norms = np.linalg.norm(rows[:, 3:7], axis=1)
    return bool((np.abs(norms - 1.0) < _NORM_TOLERANCE).all())


def _postures(rows: Array, has_pose: bool, names: tuple[str, ...] | None) -> list[Posture]:
    if not has_pose:
        return [Posture(None, JointValues(row, names)) for row in rows]
    return [
        Posture(WrittenPose(position=row[:3], quaternion=row[3:7]), JointValues(row[7:], names))
        for row in rows
    ]


def _joint_names(data: Mapping[str, Any], count: int, path: Path) -> tuple[str, ...] | None:
    if data.get("joint_names") is None:
        return None
    names = as_names(data["joint_names"], path, "joint_names")
    if len(names) != count:
        raise InputError(path, "joint_names", f"must be {count} names, as there are joints, not {len(names)}")
    return names


def _objects(data: Mapping[str, Any], count: int, path: Path) -> list[WrittenObject]:
    """The object of each grasp, one instance for those that share it."""
    where = "obj_path" if "obj_path" in data else "scene_path"
    written: Any = data.get(where)
    if shape_of(written)[:1] == (1,):
        written = written[0]
    object_path = as_text(written, path, where)
    field = "obj_scale" if "obj_scale" in data else "scene_scale"
    value: Any = data.get(field)
    # Three numbers for three grasps are a scale each: so many along x, y, z are not in use here.
    if count > 1 and shape_of(value)[:1] == (count,):
        scales = [as_scale(one, path, f"{field}.{i}") for i, one in enumerate(value)]
    else:
        scales = [as_scale(value, path, field)] * count
    made = {scale: WrittenObject(path=object_path, scale=scale) for scale in set(scales)}
    return [made[scale] for scale in scales]


def _object_pose(data: Mapping[str, Any], count: int, path: Path) -> list[WrittenPose] | None:
    if data.get("obj_pose") is None:
        return None
    value = data["obj_pose"]
    if shape_of(value) == (4, 4):
        return [WrittenPose(matrix=as_numbers(value, (4, 4), path, "obj_pose"))] * count
    rows = _rows(value, path, "obj_pose")
    if rows.shape[1] != 7 or len(rows) not in (1, count):
        raise InputError(path, "obj_pose", "must be a position and a quaternion, once or for each grasp")
    as_quaternions(rows[:, 3:], path, "obj_pose")
    poses = [WrittenPose(position=row[:3], quaternion=row[3:]) for row in rows]
    return poses * count if len(poses) == 1 else poses


def _labels(data: Mapping[str, Any], count: int, path: Path) -> dict[str, list[float | bool]]:
    skip = (*_MOMENTS, *_OTHERS, *_OBJECT, "robot_pose")
    if count == 1:
        return {name: [value] for name, value in scalars(data, skip)}
    fit = {name: value for name, value in data.items() if shape_of(value)[:1] == (count,)}
    return columns(fit, skip, count, path, "")


def _object_remarks(data: Mapping[str, Any]) -> list[str]:
    if "obj_path" not in data and "scene_path" not in data:
        return ["it names no object, as templates do"]
    if "obj_scale" not in data:
        return ["the scale of its object stands in the file that scene_path names"]
    return []
