"""Simox grasp sets: poses of the object in the frame of the hand's tool centre point, in millimetres."""

from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import rotation_from_quaternion
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
from .placing import fixed_axes
from .values import MOST_GRASPS, as_numbers, as_quaternions, as_text, check_rotations

__all__ = ["is_simox", "read_simox"]

FORMAT = "simox"
_DEGREES = ("degree", "deg")
_RADIANS = ("radian", "rad", "")
_LENGTHS = {"mm": 1.0, "millimeter": 1.0, "m": 1e3, "meter": 1e3, "": 1.0}


def is_simox(root: Element) -> bool:
    """Whether a document is an object with grasps, or a set of grasps."""
    return _is(root, "GraspSet") or any(_is(element, "GraspSet") for element in root)


def read_simox(root: Element, path: Path) -> GraspFile:
    """The grasps of all sets of an object.

    Raises:
        InputError: naming the element and what is allowed.
    """
    sets = [root] if _is(root, "GraspSet") else [element for element in root if _is(element, "GraspSet")]
    object_ = _object(root, path)
    grasps: list[Grasp] = []
    for k, each in enumerate(sets):
        hand = WrittenHand(_name(each, "EndEffector", path), "", _name(each, "RobotType", path))
        entries = [element for element in each if _is(element, "Grasp")]
        grasps += [
            _grasp(entry, hand, object_, path, f"GraspSet.{k}.Grasp.{i}") for i, entry in enumerate(entries)
        ]
        if len(grasps) > MOST_GRASPS:
            raise InputError(path, "GraspSet", f"has more than {MOST_GRASPS} grasps")
    if not grasps:
        raise InputError(path, "GraspSet", "holds no grasps")
    return GraspFile(
        path,
        FORMAT,
        "an object with grasp sets" if len(sets) and sets[0] is not root else "a grasp set",
        tuple(grasps),
        questions(length="mm", angle="rad", joint_length="mm", frame="tcp", direction="object_in_hand"),
        {},
        tuple(_remarks(grasps, len(sets))),
    )


def _is(element: Element, name: str) -> bool:
    # Its own reader takes no notice of capitals.
    return element.tag.lower() == name.lower()


def _child(element: Element, name: str) -> Element | None:
    return next((child for child in element if _is(child, name)), None)


def _name(element: Element, attribute: str, path: Path) -> str:
    found = {key.lower(): value for key, value in element.attrib.items()}
    return as_text(found.get(attribute.lower()), path, f"{element.tag}.{attribute}")


def _object(root: Element, path: Path) -> WrittenObject:
    mesh = ""
    for part in ("CollisionModel", "Visualization"):
        model = _child(root, part)
        file = None if model is None else _child(model, "File")
        if file is not None and not mesh:
            mesh = as_text((file.text or "").strip(), path, f"{part}.File")
    is_set = _is(root, "GraspSet")
    return WrittenObject(name="" if is_set else _name(root, "name", path), path=mesh)


def _grasp(entry: Element, hand: WrittenHand, object_: WrittenObject, path: Path, field: str) -> Grasp:
    transform = _child(entry, "Transform")
    if transform is None:
        raise InputError(path, f"{field}.Transform", "is required")
    quality = _name(entry, "quality", path)
    pose = WrittenPose(matrix=_matrix(transform, path, f"{field}.Transform"))
    return Grasp(
        _name(entry, "name", path),
        Posture(pose, _joints(_child(entry, "Configuration"), path, f"{field}.Configuration")),
        hand=hand,
        object=object_,
        labels={"quality": _number(quality, path, f"{field}.quality")} if quality else {},
    )


def _matrix(transform: Element, path: Path, field: str) -> Array:
    """The matrix (4, 4), in mm."""
    T = np.eye(4)
    matrix = _child(transform, "Matrix4x4")
    if matrix is not None:
        rows = [_child(matrix, f"row{i}") for i in range(1, 5)]
        if any(row is None for row in rows):
            raise InputError(path, f"{field}.Matrix4x4", "must have row1 to row4")
        values = [[row.get(f"c{k}") for k in range(1, 5)] for row in rows if row is not None]
        T = as_numbers([[_number(v, path, field) for v in row] for row in values], (4, 4), path, field)
        T[:3, 3] *= _length(matrix, path, field)
    if (moved := _child(transform, "Translation")) is not None:
        T[:3, 3] = _three(moved, ("x", "y", "z"), path, field) * _length(moved, path, field)
    if (turned := _child(transform, "Quaternion")) is not None:
        x, y, z = _three(turned, ("x", "y", "z"), path, field)
        w = _number(turned.get("w"), path, field)
        T[:3, :3] = rotation_from_quaternion(as_quaternions([[w, x, y, z]], path, field)[0])
    if (turned := _child(transform, "rollpitchyaw")) is not None:
        angles = _three(turned, ("roll", "pitch", "yaw"), path, field)
        T[:3, :3] = fixed_axes(angles * _turn(turned, path, field))
    check_rotations(T[None, :3, :3], path, field)
    return T


def _three(element: Element, names: tuple[str, ...], path: Path, field: str) -> Array:
    return as_numbers([_number(element.get(name), path, field) for name in names], (3,), path, field)


def _turn(element: Element, path: Path, field: str) -> float:
    """What the angles of an element are in rad."""
    found = {key.lower(): value.lower() for key, value in element.attrib.items()}
    unit = found.get("unitsangle") or found.get("unit") or found.get("units") or ""
    if unit not in (*_DEGREES, *_RADIANS):
        raise InputError(path, field, f"has angles in {unit[:20]!r}; known: radian and degree")
    return float(np.deg2rad(1.0)) if unit in _DEGREES else 1.0


def _length(element: Element, path: Path, field: str) -> float:
    """What the lengths of an element are in mm."""
    unit = (element.get("unitsLength") or element.get("unitslength") or element.get("units") or "").lower()
    if unit not in _LENGTHS:
        raise InputError(path, field, f"has lengths in {unit[:20]!r}; known: mm and m")
    return _LENGTHS[unit]


def _joints(configuration: Element | None, path: Path, field: str) -> JointValues | None:
    """Joints by name, in radians where their unit is one of angles."""
    nodes = [] if configuration is None else [node for node in configuration if _is(node, "Node")]
    if not nodes:
        return None
    names, values = [_name(node, "name", path) for node in nodes], []
    if len(set(names)) < len(names):
        raise InputError(path, field, "must not name a joint twice")
    for node in nodes:
        unit = (node.get("unit") or node.get("units") or "").lower()
        if unit not in (*_DEGREES, *_RADIANS, *_LENGTHS):
            raise InputError(path, field, f"has a joint in {unit[:20]!r}; known: radian, degree, mm")
        value = _number(node.get("value"), path, field)
        values.append(np.deg2rad(value) if unit in _DEGREES else value * _LENGTHS.get(unit, 1.0))
    return JointValues(np.array(values), tuple(names))


def _number(text: Any, path: Path, field: str) -> float:
    try:
        value = float(text)
    except (TypeError, ValueError):
        raise InputError(path, field, "must have numbers in all its attributes") from None
    return float(as_numbers(value, (), path, field))


def _remarks(grasps: list[Grasp], sets: int) -> list[str]:
    remarks = []
    if sets > 1:
        remarks.append(f"it has {sets} grasp sets, for a hand each")
    if all(grasp.labels.get("quality", 0.0) == 0.0 for grasp in grasps):
        remarks.append("its quality is 0 throughout, as that of grasps made by hand is")
    if all(grasp.grasp.joints is None for grasp in grasps):
        remarks.append("it has no joints, only poses")
    return remarks
