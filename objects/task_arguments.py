"""What a task is given in Python: checked as strictly as what stands in a task file."""

import math
from collections.abc import Sequence
from dataclasses import replace
from numbers import Integral

import numpy as np

from ..arguments import check_number
from ..base.files.fields import Vector3, check_name
from ..base.numeric.arrays import Array
from ..errors import InputError
from ..geometry import PointRegion
from .object_model import ObjectModel
from .physical_test import LiftTest, PhysicalTest, PressTest, TurnTest
from .physical_test_checks import check_contacts, check_parts, unit_vector

__all__ = ["checked_name", "checked_pose", "checked_support", "checked_test"]

# What is this near to a unit vector, or to a rotation, is left as it is.
_ROUNDING = 1e-6


def checked_name(name: object, source: str) -> str:
    """The name of a task.

    Raises:
        InputError: it is no name.
    """
    if not isinstance(name, str):
        raise InputError(source, "name", f"must be text, not {name!r}")
    try:
        return check_name(name)
    except ValueError as error:
        raise InputError(source, "name", str(error)) from None


def checked_pose(pose: object, source: str, field: str) -> Array:
    """A pose (4, 4): a rotation and a translation in m.

    Raises:
        InputError: it is none.
    """
    try:
        T = np.array(pose, dtype=float)
    except (TypeError, ValueError):
        raise InputError(source, field, "must be a pose (4, 4) of numbers") from None
    if T.shape != (4, 4):
        raise InputError(source, field, f"must be a pose (4, 4), not {T.shape}")
    R = T[:3, :3]
    # Compared this way round, NaN fails too.
    is_rotation = np.all(np.abs(R @ R.T - np.eye(3)) <= _ROUNDING) and np.linalg.det(R) > 0.0
    if not (is_rotation and np.all(np.isfinite(T)) and np.allclose(T[3], (0.0, 0.0, 0.0, 1.0))):
        raise InputError(
            source, field, "must be a pose: a rotation without scale or mirror, and a last row 0, 0, 0, 1"
        )
    return T


def checked_support(support: object, source: str) -> PointRegion:
    """The plane on which an object stands.

    Raises:
        InputError: it is none.
    """
    if not isinstance(support, PointRegion):
        allowed = "must be a plane in the object's frame: PointRegion(point, normal) of holdfast.geometry"
        raise InputError(source, "support", f"{allowed}, not {support!r}")
    point = _vector(support.point, source, "support.point")
    normal = _unit(support.normal, source, "support.normal")
    return replace(support, point=np.array(point), normal=np.array(normal))


def checked_test(test: object, obj: ObjectModel, n_contacts: int, source: str) -> PhysicalTest:
    """A test of a task with `n_contacts` contacts on `obj`; directions and axes become unit vectors.

    Raises:
        InputError: it is none, or asks for parts or contacts that are not there, or for what is no number.
    """
    match test:
        case LiftTest():
            directions = _listed(test.directions, source, "test.directions")
            if not directions:
                raise InputError(source, "test.directions", "needs at least one direction of gravity")
            return replace(
                test,
                parts=_parts(test.parts, obj, source),
                directions=tuple(_unit(v, source, f"test.directions.{i}") for i, v in enumerate(directions)),
            )
        case TurnTest():
            return replace(
                test,
                parts=_parts(test.parts, obj, source),
                hinge_point=_vector(test.hinge_point, source, "test.hinge_point"),
                hinge_axis=_unit(test.hinge_axis, source, "test.hinge_axis"),
                friction_torque_Nm=_positive(test.friction_torque_Nm, source, "test.friction_torque_Nm"),
                angle_rad=_positive(test.angle_rad, source, "test.angle_rad", 2.0 * math.pi),
            )
        case PressTest():
            force_N = _positive(test.force_N, source, "test.force_N")
            return replace(test, contacts=_contacts(test.contacts, n_contacts, source), force_N=force_N)
        case _:
            allowed = "must be a LiftTest, a TurnTest or a PressTest"
            raise InputError(source, "test", f"{allowed}, not {test!r}")


def _listed(values: object, source: str, field: str) -> list[object]:
    """The values of a sequence or an array; text is no sequence here."""
    if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray):
        raise InputError(source, field, f"must be a tuple, not {values!r}")
    return list(values)


def _parts(names: object, obj: ObjectModel, source: str) -> tuple[str, ...]:
    listed = [str(name) for name in _listed(names, source, "test.parts")]
    check_parts(listed, obj, source)
    return tuple(listed)


def _contacts(numbers: object, n_contacts: int, source: str) -> tuple[int, ...]:
    listed = _listed(numbers, source, "test.contacts")
    if not listed:
        raise InputError(source, "test.contacts", "needs the number of at least one contact")
    found = [_contact(number, n_contacts, source, f"test.contacts.{i}") for i, number in enumerate(listed)]
    check_contacts(found, n_contacts, source)
    return tuple(found)


def _contact(number: object, n_contacts: int, source: str, field: str) -> int:
    if isinstance(number, bool) or not isinstance(number, Integral) or int(number) < 0:
        raise InputError(source, field, f"contacts are numbered 0 to {n_contacts - 1}")
    return int(number)


def _vector(value: object, source: str, field: str) -> Vector3:
    try:
        v = np.array(value, dtype=float)
    except (TypeError, ValueError):
        v = np.full(3, np.nan)
    if v.shape != (3,) or not np.all(np.isfinite(v)):
        raise InputError(source, field, "must be three finite numbers")
    x, y, z = v.tolist()
    return x, y, z


def _unit(value: object, source: str, field: str) -> Vector3:
    v = _vector(value, source, field)
    unit = unit_vector(v, source, field)
    # A unit vector stays the one that it is, to the last digit.
    return v if abs(math.hypot(*v) - 1.0) < _ROUNDING else unit


def _positive(value: object, source: str, field: str, most: float = math.inf) -> float:
    try:
        number = check_number(field, value, above=0.0)
    except InputError as error:
        raise InputError(source, field, error.allowed) from None
    if number > most:
        raise InputError(source, field, f"must be at most {most:.4g}, not {number:g}")
    return number
