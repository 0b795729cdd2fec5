"""Poses without more: matrices alone, rows of position and quaternion, and graspnet-1Billion's rows."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from .grasp_file import (
    Grasp,
    GraspFile,
    Posture,
    WrittenHand,
    WrittenObject,
    WrittenPose,
    questions,
)
from .matrices import columns, matrix_grasps
from .values import as_matrices, as_numbers, as_quaternions, check_rotations, shape_of

__all__ = ["is_bare", "is_billion", "read_bare", "read_billion"]

BARE = "bare"
BILLION = "graspnet1billion"
_MATRICES = (
    *(
        "pred_grasps_cam",
        "grasps",
        "transforms",
        "grasp_poses",
        "poses",
        "grasp_transforms",
        "generated_grasps",
    ),
    *("T", "arr_0"),
)
_WIDTHS = ("gripper_openings", "widths", "width")
_MOST_SETS = 10_000
_NO_HAND = "it names no hand and no object"


def is_billion(data: Any) -> bool:
    """Whether this is an array (N, 17) whose rows hold a rotation."""
    shape = shape_of(data)
    return len(shape) == 2 and shape[1] == 17


def read_billion(data: Any, path: Path) -> GraspFile:
    """Rows of graspnet-1Billion: score, width, height, depth, rotation (9), translation (3), object.

    Raises:
        InputError: naming the field and what is allowed.
    """
    rows = as_numbers(data, (None, 17), path, "")
    if not len(rows):
        raise InputError(path, "", "holds no grasps")
    R = rows[:, 4:13].reshape(-1, 3, 3)
    check_rotations(R, path, "rotation")
    objects = {number: WrittenObject(name=f"{number:g}") for number in set(rows[:, 16])}
    grasps = tuple(
        Grasp(
            str(i),
            Posture(WrittenPose(position=row[13:16], rotation=R[i])),
            object=objects[row[16]],
            width=float(row[1]),
            labels={"score": float(row[0])},
            numbers={"height": float(row[2]), "depth": float(row[3])},
        )
        for i, row in enumerate(rows)
    )
    remarks = (
        "its poses are in the frame of the camera or scene, not of an object",
        "its depth is how far the fingers reach beyond the written point, along the rotation's first axis",
    )
    open_ones = questions(length="m", frame="tcp", direction="hand_in_object", width="gap")
    return GraspFile(path, BILLION, "rows of 17 numbers", grasps, open_ones, {}, remarks)


def is_bare(data: Any) -> bool:
    """Whether this is matrices, or rows of position and quaternion, alone or under a name that is in use."""
    if isinstance(data, Mapping):
        name = _name(data)
        return bool(name) and (isinstance(_unwrapped(data[name]), Mapping) or is_bare(data[name]))
    shape = shape_of(data)
    is_matrix = shape[-2:] in ((4, 4), (3, 4)) and len(shape) in (2, 3)
    return is_matrix or (len(shape) == 2 and shape[1] in (7, 16))


def read_bare(data: Any, path: Path) -> GraspFile:
    """The poses of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    if not isinstance(data, Mapping):
        grasps, remark, has_quaternion = _poses(data, path, "")
        return _file(path, "an array alone", grasps, [remark, _NO_HAND], has_quaternion)
    name = _name(data)
    rest = {key: value for key, value in data.items() if key != name}
    value = _unwrapped(data[name])
    if isinstance(value, Mapping):
        return _file(path, f"sets of matrices in {name}", *_sets(value, rest, path, name))
    grasps, remark, has_quaternion = _poses(value, path, name)
    grasps = _labelled(grasps, _fit(rest, len(grasps)), path, "")
    taken = "" if name in _MATRICES else f"{name}, the only matrices in it, is taken for its grasps"
    return _file(path, f"an array in {name}", grasps, [remark, taken, _NO_HAND], has_quaternion)


def _file(
    path: Path, variant: str, grasps: tuple[Grasp, ...], remarks: list[str], has_quaternion: bool
) -> GraspFile:
    if not grasps:
        raise InputError(path, "", "holds no grasps")
    open_ones = questions(length="m", frame=None, direction="hand_in_object")
    if has_quaternion:
        open_ones = (*questions(quaternion=None), *open_ones)
    return GraspFile(path, BARE, variant, grasps, open_ones, {}, tuple(filter(None, remarks)))


def _name(data: Mapping[str, Any]) -> str:
    known = next((name for name in _MATRICES if name in data), "")
    if known:
        return known
    found = [name for name, value in data.items() if _is_table(value)]
    return found[0] if len(found) == 1 and isinstance(found[0], str) else ""


def _is_table(value: Any) -> bool:
    """Whether a value is matrices by its shape, under whatever name."""
    shape = shape_of(value)
    return len(shape) == 3 and shape[1:] == (4, 4)


def _unwrapped(value: Any) -> Any:
    return (
        value.item() if isinstance(value, np.ndarray) and value.dtype == object and value.size == 1 else value
    )


def _poses(value: Any, path: Path, field: str) -> tuple[tuple[Grasp, ...], str, bool]:
    shape = shape_of(value)
    if len(shape) == 2 and shape[1] == 7:
        rows = as_numbers(value, (None, 7), path, field)
        as_quaternions(rows[:, 3:], path, field)
        poses = [WrittenPose(position=row[:3], quaternion=row[3:]) for row in rows]
        return tuple(Grasp(str(i), Posture(pose)) for i, pose in enumerate(poses)), "", True
    matrices, remark = as_matrices([value] if len(shape) == 2 and shape[1] == 4 else value, path, field)
    return _of(matrices), remark, False


def _of(matrices: Array) -> tuple[Grasp, ...]:
    return matrix_grasps(matrices, hand=WrittenHand(), object_=WrittenObject(), labels={})


def _sets(
    sets: Mapping[str, Any], rest: Mapping[str, Any], path: Path, name: str
) -> tuple[tuple[Grasp, ...], list[str], bool]:
    """Matrices by segment of a picture, as Contact-GraspNet writes them."""
    if len(sets) > _MOST_SETS:
        raise InputError(path, name, f"holds more than {_MOST_SETS} sets")
    found: list[Grasp] = []
    for key, value in sets.items():
        if not len(shape_of(value)) or not shape_of(value)[0]:
            continue
        matrices, _ = as_matrices(value, path, f"{name}.{key}")
        beside = {label: _unwrapped(column) for label, column in rest.items()}
        mine = {label: column[key] for label, column in beside.items() if _has(column, key)}
        grasps = _labelled(_of(matrices), _fit(mine, len(matrices)), path, str(key))
        object_ = WrittenObject(name=str(key))
        found += [replace(grasp, name=f"{key}/{grasp.name}", object=object_) for grasp in grasps]
    remark = "its poses are in the frame of the camera, by segment of the picture"
    return tuple(found), [remark, "it names no hand"], False


def _has(column: Any, key: Any) -> bool:
    return isinstance(column, Mapping) and key in column


def _fit(data: Mapping[str, Any], count: int) -> dict[str, Any]:
    """What has one entry for each grasp."""
    return {str(key): value for key, value in data.items() if shape_of(value)[:1] == (count,)}


def _labelled(
    grasps: tuple[Grasp, ...], data: Mapping[str, Any], path: Path, within: str
) -> tuple[Grasp, ...]:
    found = columns(data, (), len(grasps), path, within)
    width = next((name for name in _WIDTHS if name in found), "")
    widths = found.pop(width, [])
    return tuple(
        replace(
            grasp,
            width=float(widths[i]) if widths else None,
            labels={name: values[i] for name, values in found.items()},
        )
        for i, grasp in enumerate(grasps)
    )
