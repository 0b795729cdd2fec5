"""What files of matrices alone have in common: one gripper pose a grasp, and labels beside it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from .grasp_file import Grasp, JointValues, Posture, WrittenHand, WrittenObject, WrittenPose
from .values import as_names, as_numbers

__all__ = ["columns", "joint_rows", "matrix_grasps"]


def matrix_grasps(
    matrices: Array,
    *,
    hand: WrittenHand,
    object_: WrittenObject,
    labels: Mapping[str, list[float | bool]],
    widths: Array | None = None,
    joints: Sequence[JointValues] | JointValues | None = None,
) -> tuple[Grasp, ...]:
    """A grasp for each of N matrices (N, 4, 4), with the labels of the same row."""
    return tuple(
        Grasp(
            str(i),
            Posture(WrittenPose(matrix=matrix), joints[i] if isinstance(joints, Sequence) else joints),
            hand=hand,
            object=object_,
            width=None if widths is None else float(widths[i]),
            labels={name: values[i] for name, values in labels.items()},
        )
        for i, matrix in enumerate(matrices)
    )


def joint_rows(names: Any, rows: Any, count: int, path: Path, fields: tuple[str, str]) -> list[JointValues]:
    """Joint values of each of `count` grasps, from a list of names and a table (count, k).

    Raises:
        InputError: naming the first or the second of the fields.
    """
    known = as_names(names, path, fields[0])
    values = as_numbers(rows, (None, len(known)), path, fields[1])
    if len(values) != count:
        raise InputError(path, fields[1], f"must have {count} rows, one for each grasp, not {len(values)}")
    return [JointValues(row, known) for row in values]


def columns(
    data: Mapping[str, Any], skip: tuple[str, ...], count: int, path: Path, within: str
) -> dict[str, list[float | bool]]:
    """The fields of a mapping that hold one number or yes or no for each of `count` grasps.

    Raises:
        InputError: such a field has another length, or numbers that are none.
    """
    found: dict[str, list[float | bool]] = {}
    for name, value in data.items():
        if name in skip or not isinstance(value, (list, tuple, np.ndarray)):
            continue
        array = _column(value)
        if array is None:
            continue
        field = f"{within}.{name}" if within else str(name)
        if len(array) != count:
            raise InputError(path, field, f"must have {count} values, one for each grasp, not {len(array)}")
        is_yes_or_no = all(isinstance(item, (bool, np.bool_)) for item in array)
        found[str(name)] = (
            [bool(item) for item in array]
            if is_yes_or_no
            else as_numbers([float(item) for item in array], (count,), path, field).tolist()
        )
    return found


def _column(value: Any) -> list[Any] | None:
    if isinstance(value, np.ndarray):
        if value.ndim == 2 and value.shape[1] == 1:
            value = value[:, 0]
        if value.ndim != 1:
            return None
        value = value.tolist()
    # Of two columns of one number each, as (N, 1), so are lists.
    flat = [item[0] if isinstance(item, list) and len(item) == 1 else item for item in value]
    return flat if flat and set(map(type, flat)) <= {int, float, bool} else None
