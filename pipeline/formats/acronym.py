"""ACRONYM HDF5, and files of others that look like it."""

import io
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...base.machine.extras import from_extra
from ...base.numeric.arrays import Array
from ...errors import InputError
from .grasp_file import GraspFile, JointValues, WrittenHand, WrittenObject, questions
from .matrices import columns, joint_rows, matrix_grasps
from .values import as_matrices, as_number, as_numbers, as_scale, as_text, shape_of

__all__ = ["read_acronym"]

FORMAT = "acronym"
_MOST_SETS = 1000
_DEEPEST = 16
_LARGEST_BYTES = 256 * 1024 * 1024
_MATRICES = ("grasps/transforms", "transforms", "grasps", "grasp_transforms", "poses", "pred_grasps_cam")
_QUALITIES = "grasps/qualities/"


def read_acronym(data: bytes, path: Path) -> GraspFile:
    """The grasps of an HDF5 file.

    Raises:
        InputError: naming the data set and what is allowed.
        MissingBackend: the package h5py is not installed.
    """
    sets = _data_sets(data, path)
    name = next((name for name in _MATRICES if name in sets), "") or _only_matrices(sets)
    if not name:
        found = ", ".join(sorted(sets)[:10]) or "none"
        raise InputError(path, "grasps/transforms", f"is required; the data sets here are: {found}")
    matrices, names, variant, remarks = _matrices(sets[name], path, name)
    labels = {
        key.rpartition("/")[2]: values
        for key, values in columns(_per_grasp(sets, name), (), len(names), path, "").items()
    }
    if len(matrices) != len(names):
        labels = {key: [value for value in values for _ in range(2)] for key, values in labels.items()}
        names = [f"{name}/{side}" for name in names for side in range(2)]
    object_ = _object(sets, path)
    hand, joints = _hand(sets, len(matrices), path)
    grasps = matrix_grasps(matrices, hand=hand, object_=object_, labels=labels, joints=joints)
    return GraspFile(
        path,
        FORMAT,
        variant,
        tuple(replace(grasp, name=name) for grasp, name in zip(grasps, names, strict=True)),
        questions(
            length="m",
            joint_length="m",
            frame="base",
            direction="hand_in_object",
            **({} if object_.scale is None else {"scale": "times"}),
            **({"joint_order": None} if isinstance(joints, JointValues) else {}),
        ),
        {},
        tuple(remarks),
    )


def _only_matrices(sets: dict[str, Any]) -> str:
    """The data set that holds matrices, where that is one alone."""
    found = [name for name, value in sets.items() if shape_of(value)[-2:] == (4, 4)]
    return found[0] if len(found) == 1 and len(shape_of(sets[found[0]])) in (3, 4) else ""


def _matrices(value: Any, path: Path, name: str) -> tuple[Array, list[str], str, list[str]]:
    """Matrices in a row, names of the grasps, what the layout is, and remarks."""
    if isinstance(value, np.ndarray) and value.ndim == 4 and value.shape[1:] == (2, 4, 4):
        matrices, _ = as_matrices(value.reshape(-1, 4, 4), path, name)
        remark = "each grasp has two grippers, which are read as a grasp each, in the frame that the file has"
        return matrices, [str(i) for i in range(len(value))], "two grippers a grasp", [remark]
    matrices, remark = as_matrices(value, path, name)
    variant = "as ACRONYM has it" if name == _MATRICES[0] else f"matrices in {name}"
    return matrices, [str(i) for i in range(len(matrices))], variant, [remark] if remark else []


def _per_grasp(sets: dict[str, Any], name: str) -> dict[str, Any]:
    """The data sets that may be labels: the qualities, or all beside the matrices where there are none."""
    qualities = {key: value for key, value in sets.items() if key.startswith(_QUALITIES)}
    beside = {key: value for key, value in sets.items() if key.startswith("grasps/") and key != name}
    count = len(sets[name])
    other = {key: value for key, value in (beside or sets).items() if shape_of(value)[:1] == (count,)}
    return qualities or {key: value for key, value in other.items() if key != name}


def _object(sets: dict[str, Any], path: Path) -> WrittenObject:
    mass = sets.get("object/mass")
    return WrittenObject(
        name=as_text(sets.get("object/name"), path, "object/name"),
        path=as_text(sets.get("object/file"), path, "object/file"),
        scale=as_scale(sets.get("object/scale"), path, "object/scale"),
        mass=None if mass is None else as_number(mass, path, "object/mass"),
    )


def _hand(
    sets: dict[str, Any], count: int, path: Path
) -> tuple[WrittenHand, list[JointValues] | JointValues | None]:
    """The gripper, and its joints: of all grasps, or of each, as Holdfast adds them."""
    hand = WrittenHand(name=as_text(sets.get("gripper/type"), path, "gripper/type"))
    fields = ("gripper/joint_names", "grasps/configurations")
    if all(field in sets for field in fields):
        return hand, joint_rows(sets[fields[0]], sets[fields[1]], count, path, fields)
    written = sets.get("gripper/configuration")
    if written is None:
        return hand, None
    values = as_numbers(np.atleast_1d(written), (None,), path, "gripper/configuration")
    return hand, JointValues(values)


def _data_sets(data: bytes, path: Path) -> dict[str, Any]:
    h5py = from_extra("h5py", "formats", "reading HDF5")
    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            return dict(_walk(file, "", path, [0, 0]))
    except (OSError, RuntimeError, KeyError, TypeError, ValueError, OverflowError, AttributeError):
        # h5py answers damage with whatever its library met.
        raise InputError(path, "", "a damaged HDF5 file") from None


def _walk(group: Any, prefix: str, path: Path, spent: list[int]) -> Iterator[tuple[str, Any]]:
    """All data sets below a group by their path; `spent` counts them and their bytes."""
    import h5py

    for key in group:
        name = f"{prefix}{key}"
        if not isinstance(group.get(key, getlink=True), h5py.HardLink):
            raise InputError(path, name, "is a link, which is not followed")
        spent[0] += 1
        if spent[0] > _MOST_SETS or name.count("/") > _DEEPEST:
            raise InputError(
                path, "", f"has more than {_MOST_SETS} data sets, or {_DEEPEST} levels of groups"
            )
        item = group[key]
        if isinstance(item, h5py.Group):
            yield from _walk(item, f"{name}/", path, spent)
        elif isinstance(item, h5py.Dataset):
            yield name, _content(item, name, path, spent)


def _content(item: Any, name: str, path: Path, spent: list[int]) -> Any:
    if item.external or item.is_virtual:
        raise InputError(path, name, "keeps its content in other files, which are not opened")
    spent[1] += item.size * item.dtype.itemsize if item.size else 0
    if spent[1] > _LARGEST_BYTES:
        raise InputError(path, name, f"the data sets are larger than {_LARGEST_BYTES >> 20} MiB")
    return item[()]
