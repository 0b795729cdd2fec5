"""GraspGen JSON, and older files with the same fields at the top: matrices of a gripper and a mask."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import InputError
from .grasp_file import GraspFile, JointValues, Question, WrittenHand, WrittenObject, questions
from .matrices import columns, joint_rows, matrix_grasps
from .values import as_matrices, as_number, as_numbers, as_scale, as_text, required

__all__ = ["is_graspgen", "read_graspgen"]

FORMAT = "graspgen"
_OFFSET = "transform_offset_from_asset_to_graspgen_convention"


def is_graspgen(data: Any) -> bool:
    """Whether a file's fields are those of this format."""
    if not isinstance(data, Mapping):
        return False
    grasps = data.get("grasps")
    return (isinstance(grasps, Mapping) and "transforms" in grasps) or "transforms" in data


def read_graspgen(data: Mapping[str, Any], path: Path) -> GraspFile:
    """The grasps of a file.

    Raises:
        InputError: naming the field and what is allowed.
    """
    is_nested = isinstance(data.get("grasps"), Mapping)
    grasps, within = (data["grasps"], "grasps") if is_nested else (data, "")
    field = f"{within}.transforms" if within else "transforms"
    matrices, remark = as_matrices(required(grasps, "transforms", path, within), path, field)
    labels = columns(grasps, ("transforms", "joint_positions"), len(matrices), path, within)
    object_ = _object(data, path)
    hand, offset = _hand(data.get("gripper"), path)
    joints = _joints(data, len(matrices), path) if is_nested else None
    return GraspFile(
        path,
        FORMAT,
        "object, gripper and grasps" if is_nested else "transforms at the top, as 6-DoF GraspNet has them",
        matrix_grasps(matrices, hand=hand, object_=object_, labels=labels, joints=joints),
        (
            *questions(
                length="m",
                frame="base",
                direction="hand_in_object",
                **({} if object_.scale is None else {"scale": "times"}),
            ),
            *offset,
        ),
        {},
        (remark,) if remark else (),
    )


def _joints(data: Mapping[str, Any], count: int, path: Path) -> list[JointValues] | None:
    """Joints of each grasp, which the format has no place for, as Holdfast adds them."""
    gripper = data.get("gripper")
    if not isinstance(gripper, Mapping) or not gripper.get("joint_names"):
        return None
    fields = ("gripper.joint_names", "grasps.joint_positions")
    rows = required(data["grasps"], "joint_positions", path, "grasps")
    return joint_rows(gripper["joint_names"], rows, count, path, fields)


def _object(data: Mapping[str, Any], path: Path) -> WrittenObject:
    written = data.get("object")
    if isinstance(written, Mapping):
        return WrittenObject(
            name=as_text(written.get("name"), path, "object.name"),
            path=as_text(written.get("file"), path, "object.file"),
            scale=as_scale(written.get("scale"), path, "object.scale"),
        )
    return WrittenObject(
        path=as_text(written, path, "object"),
        scale=as_scale(data.get("object_scale"), path, "object_scale"),
    )


def _hand(written: Any, path: Path) -> tuple[WrittenHand, tuple[Question, ...]]:
    if written is None:
        return WrittenHand(), ()
    if isinstance(written, str):
        return WrittenHand(name=as_text(written, path, "gripper")), ()
    if not isinstance(written, Mapping):
        raise InputError(path, "gripper", "must be a name, or fields such as name, width and depth")
    numbers: dict[str, float | tuple[float, ...]] = {
        name: as_number(written[name], path, f"gripper.{name}")
        for name in ("width", "depth")
        if written.get(name) is not None
    }
    offset: tuple[Question, ...] = ()
    if written.get(_OFFSET) is not None:
        numbers[_OFFSET], offset = _offset(written[_OFFSET], path)
    name = as_text(written.get("name") or written.get("gripper_name"), path, "gripper.name")
    return WrittenHand(
        name, as_text(written.get("file_name"), path, "gripper.file_name"), "", numbers
    ), offset


def _offset(written: Any, path: Path) -> tuple[tuple[float, ...], tuple[Question, ...]]:
    """The numbers of the offset in a row, and what is open where they are a position and a quaternion."""
    field = f"gripper.{_OFFSET}"
    if isinstance(written, list) and len(written) == 2:
        position = as_numbers(written[0], (3,), path, f"{field}.0")
        quaternion = as_numbers(written[1], (4,), path, f"{field}.1")
        # The document of the format has w last, and the authors' converter reads it first.
        return (*position.tolist(), *quaternion.tolist()), (Question.of("quaternion", "xyzw"),)
    if isinstance(written, list) and len(written) == 4:
        return tuple(as_numbers(written, (4, 4), path, field).ravel().tolist()), ()
    return tuple(as_numbers(written, (16,), path, field).tolist()), ()
