"""Values of files as arrays, numbers and text, each refused by its name where it is something else."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError, suggest

__all__ = [
    "MOST_GRASPS",
    "as_label",
    "as_matrices",
    "as_names",
    "as_number",
    "as_numbers",
    "as_quaternions",
    "as_scale",
    "as_text",
    "named_numbers",
    "required",
    "scalars",
    "shape_of",
]

MOST_GRASPS = 200_000
"""Grasps that one file may hold."""

_MOST_NUMBERS = 20_000_000
_LARGEST = 1e9
_LONGEST_TEXT = 1000
_MOST_SIDES = 8
# Rotations are written with as few as three decimals.
_ROTATION_TOLERANCE = 0.02
_NORM_TOLERANCE = 0.05


def as_numbers(value: Any, shape: tuple[int | None, ...], path: Path, field: str) -> Array:
    """The numbers of nested lists or of an array.

    Args:
        value: from the file.
        shape: the length of each side, None for any.
        path: the file.
        field: where in it.

    Raises:
        InputError: it has another shape, or something in it is not a finite number of sane size.
    """
    array = _array(value, shape)
    if array is None:
        raise InputError(path, field, f"must be {_shape_words(shape)}, not {_described(value)}")
    if not (np.abs(array) <= _LARGEST).all():
        raise InputError(path, field, f"must be finite numbers below {_LARGEST:g} in size")
    return array


def _array(value: Any, shape: tuple[int | None, ...]) -> Array | None:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray) and value.dtype != object:
        is_fit = len(value.shape) == len(shape) and all(
            side in (None, found) for side, found in zip(shape, value.shape, strict=True)
        )
        return np.array(value, dtype=float) if is_fit and value.dtype.kind in "iuf" else None
    items, sides = [value], list[int]()
    for side in shape:
        if not items or not all(map(_is_list, items)):
            return None
        lengths = set(map(len, items))
        if len(lengths) != 1 or (side is not None and lengths != {side}):
            return None
        sides.append(lengths.pop())
        if len(items) * sides[-1] > _MOST_NUMBERS:
            return None
        items = list(chain.from_iterable(map(_listed, items)))
    if not set(map(type, items)) <= {int, float}:
        return None
    try:
        return np.array(items, dtype=float).reshape(sides)
    except OverflowError:
        return None


def shape_of(value: Any) -> tuple[int, ...]:
    """The sides of an array, or of lists in lists as their first entries have them; () for others."""
    if isinstance(value, np.ndarray):
        return value.shape
    sides: list[int] = []
    while isinstance(value, (list, tuple)) and len(sides) < _MOST_SIDES:
        sides.append(len(value))
        value = value[0] if value else None
    return (*sides, *(value.shape if isinstance(value, np.ndarray) else ()))


def _is_list(value: Any) -> bool:
    return isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)


def _listed(item: Any) -> Sequence[Any]:
    found: Sequence[Any] = item.tolist() if isinstance(item, np.ndarray) else item
    return found


def _shape_words(shape: tuple[int | None, ...]) -> str:
    if not shape:
        return "a number"
    sides = ", ".join("N" if side is None else str(side) for side in shape)
    return f"numbers of shape ({sides}{',' if len(shape) == 1 else ''})"


def _described(value: Any) -> str:
    """What a value is, in few words."""
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} of shape {value.shape}"
    if isinstance(value, (str, bytes)):
        return f"text {value[:40]!r}"
    if isinstance(value, (list, tuple)):
        return f"a list of {len(value)}"
    if isinstance(value, Mapping):
        return f"a mapping of {len(value)} fields"
    return "nothing" if value is None else repr(value)[:40]


def as_matrices(value: Any, path: Path, field: str) -> tuple[Array, str]:
    """Homogeneous matrices (N, 4, 4), and a remark where they are written in an unusual way, or nothing.

    Also read are N matrices of 16 numbers in a row each, row by row, those without their last row, and those
    whose translation stands in the last row, which are turned over.

    Raises:
        InputError: they are none, or hold no rotations.
    """
    remark = ""
    if (flat := _array(value, (None, 16))) is not None:
        value, remark = flat.reshape(-1, 4, 4), "matrices are written as 16 numbers in a row"
    elif (short := _array(value, (None, 3, 4))) is not None:
        last = np.broadcast_to([[[0.0, 0.0, 0.0, 1.0]]], (len(short), 1, 4))
        value, remark = np.concatenate([short, last], axis=1), "matrices are written without their last row"
    matrices = as_numbers(value, (None, 4, 4), path, field)
    _check_count(len(matrices), path, field)
    if len(matrices) and not _has_last_row(matrices) and _has_last_row(matrices.transpose(0, 2, 1)):
        matrices, remark = matrices.transpose(0, 2, 1), "matrices are written column by column"
    if len(matrices) and not _has_last_row(matrices):
        raise InputError(path, field, "must be homogeneous matrices, whose last row is 0, 0, 0, 1")
    check_rotations(matrices[:, :3, :3], path, field)
    return matrices, remark


def _has_last_row(matrices: Array) -> bool:
    return bool((np.abs(matrices[:, 3] - [0.0, 0.0, 0.0, 1.0]) < 1e-3).all())


def _at(field: str, i: int) -> str:
    return f"{field}.{i}" if field else str(i)


def check_rotations(R: Array, path: Path, field: str) -> None:
    """Refuses matrices (N, 3, 3) that don't turn.

    Raises:
        InputError: with the first at fault.
    """
    off = np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max(axis=(1, 2), initial=0.0)
    wrong = (off > _ROTATION_TOLERANCE) | (np.linalg.det(R) < 0.0)
    if wrong.any():
        raise InputError(path, _at(field, int(wrong.argmax())), "its upper left 3 x 3 must be a rotation")


def as_quaternions(value: Any, path: Path, field: str) -> Array:
    """Quaternions (N, 4), in whatever order.

    Raises:
        InputError: they are none, or their length is not 1.
    """
    quaternions = as_numbers(value, (None, 4), path, field)
    wrong = np.abs(np.linalg.norm(quaternions, axis=1) - 1.0) > _NORM_TOLERANCE
    if wrong.any():
        raise InputError(path, _at(field, int(wrong.argmax())), "must be a quaternion, of length 1")
    return quaternions


def _check_count(count: int, path: Path, field: str) -> None:
    if count > MOST_GRASPS:
        raise InputError(path, field, f"has {count} grasps; at most {MOST_GRASPS} are read at once")


def as_number(value: Any, path: Path, field: str) -> float:
    """A number.

    Raises:
        InputError: it is none.
    """
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.reshape(())
    return float(as_numbers(value, (), path, field))


def as_scale(value: Any, path: Path, field: str) -> tuple[float, ...] | None:
    """A scale: one number, or three along x, y, z; None where there is none.

    Raises:
        InputError: it is something else, or not above 0.
    """
    if value is None:
        return None
    if not _is_list(value):
        scale: tuple[float, ...] = (as_number(value, path, field),)
    elif len(value) == 1:
        scale = (as_number(value[0], path, field),)
    else:
        scale = tuple(as_numbers(value, (3,), path, field).tolist())
    if min(scale) <= 0.0:
        raise InputError(path, field, "must be above 0")
    return scale


def as_label(value: Any, path: Path, field: str) -> float | bool:
    """A judgement: yes or no, or a number.

    Raises:
        InputError: it is neither.
    """
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.reshape(()).item()
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    return as_number(value, path, field)


def as_text(value: Any, path: Path, field: str) -> str:
    """Text; nothing is empty text, and a number is what it is written as.

    Raises:
        InputError: it is something else, or too long.
    """
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.reshape(()).item()
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    if value is None:
        return ""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return str(value)
    if not isinstance(value, str) or len(value) > _LONGEST_TEXT:
        raise InputError(path, field, f"must be text of at most {_LONGEST_TEXT} characters")
    return value


def as_names(value: Any, path: Path, field: str) -> tuple[str, ...]:
    """A list of names.

    Raises:
        InputError: it is none.
    """
    if not _is_list(value) or not all(_is_text(name) for name in value):
        raise InputError(path, field, "must be a list of names")
    names = tuple(as_text(name, path, field) for name in value)
    if len(set(names)) < len(names):
        raise InputError(path, field, "must not name anything twice")
    return names


def _is_text(value: Any) -> bool:
    return isinstance(value, (str, bytes))


def named_numbers(value: Any, path: Path, field: str) -> dict[str, float]:
    """Numbers by name.

    Raises:
        InputError: they are none.
    """
    if not isinstance(value, Mapping):
        raise InputError(path, field, "must be numbers by name")
    return {
        as_text(name, path, field): as_number(number, path, f"{field}.{name}")
        for name, number in value.items()
    }


def required(data: Mapping[str, Any], name: str, path: Path, within: str = "") -> Any:
    """A field that must be there.

    Raises:
        InputError: it is not; with the nearest that is.
    """
    if name not in data:
        field = f"{within}.{name}" if within else name
        raise InputError(path, field, f"is required{suggest(name, (str(key) for key in data))}")
    return data[name]


def scalars(data: Mapping[str, Any], skip: Sequence[str]) -> Iterator[tuple[str, Any]]:
    """The fields that hold one number or yes or no each, but for some."""
    for name, value in data.items():
        plain = value.item() if isinstance(value, (np.ndarray, np.generic)) and value.size == 1 else value
        if name not in skip and isinstance(plain, (bool, int, float)):
            yield str(name), plain
