"""The field `test` of a task file: its forms, and how the test is built from them."""

from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import Discriminator, Field, Strict, Tag

from ..base.files.fields import Vector3
from ..base.files.file_model import FileModel
from ..errors import InputError
from .object_model import ObjectModel
from .physical_test import SIX, LiftTest, PhysicalTest, PressTest, TurnTest, cone, sphere
from .physical_test_checks import check_contacts, check_once, check_parts, unit_vector

__all__ = ["PhysicalTestSpec", "build_test"]

_KINDS = ("lift", "turn", "press")
# Hands press with tens of newtons and turn with newton metres; ten times that is a slip of units.
_LARGEST_FORCE_N, _LARGEST_TORQUE_NM = 1000.0, 100.0
_MOST_PARTS = 1000

PartNames: TypeAlias = Annotated[list[str], Field(min_length=1, max_length=_MOST_PARTS)]


class ConeSpec(FileModel):
    """Directions of gravity within a cone about `axis`, in the palm frame."""

    axis: Vector3
    cone_deg: Annotated[float, Strict(), Field(gt=0, le=180)]


def _gravity_tag(value: Any) -> str | None:
    kinds = {"<named>": str, "<cone>": dict, "<listed>": list}
    return next((tag for tag, kind in kinds.items() if isinstance(value, kind)), None)


GravitySpec: TypeAlias = Annotated[
    Annotated[Literal["six", "sphere"], Tag("<named>")]
    | Annotated[ConeSpec, Tag("<cone>")]
    | Annotated[list[Vector3], Field(min_length=1, max_length=100), Tag("<listed>")],
    Discriminator(
        _gravity_tag,
        custom_error_type="gravity",
        custom_error_message="must be six, sphere, a cone {axis, cone_deg} or a list of directions",
    ),
]


class LiftSpec(FileModel):
    """`kind: lift`."""

    kind: Literal["lift"]
    parts: PartNames | None = None
    gravity: GravitySpec = "six"


class HingeSpec(FileModel):
    """`hinge:` of a turn: a line in the object's frame."""

    point: Vector3
    axis: Vector3


class TurnSpec(FileModel):
    """`kind: turn`; the torque in N m; without parts all of the object turns."""

    kind: Literal["turn"]
    parts: PartNames | None = None
    hinge: HingeSpec
    friction_torque: Annotated[float, Strict(), Field(gt=0, le=_LARGEST_TORQUE_NM)]
    angle_deg: Annotated[float, Strict(), Field(gt=0, le=360)]


class PressSpec(FileModel):
    """`kind: press`; the force in N."""

    kind: Literal["press"]
    force: Annotated[float, Strict(), Field(gt=0, le=_LARGEST_FORCE_N)]
    contacts: Annotated[list[Annotated[int, Strict(), Field(ge=0)]], Field(min_length=1)] | None = None


def _kind_tag(value: Any) -> str | None:
    kind = value.get("kind") if isinstance(value, dict) else None
    return f"<{kind}>" if kind in _KINDS else None


PhysicalTestSpec: TypeAlias = Annotated[
    Annotated[LiftSpec, Tag("<lift>")]
    | Annotated[TurnSpec, Tag("<turn>")]
    | Annotated[PressSpec, Tag("<press>")],
    Discriminator(
        _kind_tag, custom_error_type="kind", custom_error_message="needs a kind: lift, turn or press"
    ),
]


def build_test(
    spec: LiftSpec | TurnSpec | PressSpec, obj: ObjectModel, n_contacts: int, source: str
) -> PhysicalTest:
    """Builds the test of a task with `n_contacts` contacts on `obj`.

    Raises:
        InputError: parts that the object does not have, contacts that the task does not have, anything
            twice, a direction or an axis of length zero, a hinge far from the object.
    """
    match spec:
        case LiftSpec():
            return LiftTest(_build_parts(spec.parts or [], obj, source), _build_directions(spec, source))
        case TurnSpec():
            return _build_turn(spec, obj, source)
        case PressSpec():
            contacts = range(n_contacts) if spec.contacts is None else spec.contacts
            check_contacts(contacts, n_contacts, source)
            return PressTest(tuple(contacts), spec.force)


def _build_parts(names: list[str], obj: ObjectModel, source: str) -> tuple[str, ...]:
    check_parts(names, obj, source)
    check_once(names, source, "test.parts")
    return tuple(names)


def _build_directions(spec: LiftSpec, source: str) -> tuple[Vector3, ...]:
    match spec.gravity:
        case "six":
            return SIX
        case "sphere":
            return sphere()
        case ConeSpec():
            axis = unit_vector(spec.gravity.axis, source, "test.gravity.axis")
            return cone(np.array(axis), float(np.deg2rad(spec.gravity.cone_deg)))
        case directions:
            return tuple(unit_vector(v, source, f"test.gravity.{i}") for i, v in enumerate(directions))


def _build_turn(spec: TurnSpec, obj: ObjectModel, source: str) -> TurnTest:
    parts = _build_parts(spec.parts or [part.name for part in obj.parts], obj, source)
    nearest = np.clip(spec.hinge.point, *obj.mesh.bounds)
    if np.linalg.norm(nearest - spec.hinge.point) > obj.size_m:
        raise InputError(
            source, "test.hinge.point", "is farther from the object than the object is large (metres)"
        )
    axis = unit_vector(spec.hinge.axis, source, "test.hinge.axis")
    return TurnTest(parts, spec.hinge.point, axis, spec.friction_torque, float(np.deg2rad(spec.angle_deg)))
