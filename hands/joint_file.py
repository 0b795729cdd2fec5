"""Joints as they stand in hand files."""

import re
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BeforeValidator, Field, Strict, model_validator

from ..base.files.fields import Finite, Inline, Name, Named, NamedOrInline, Positive, Vector3
from ..base.files.file_model import FileModel
from ..base.numeric.arrays import Array
from ..errors import InputError, UnknownName
from ..geometry import axis_rotation, pose
from .hand import Actuator, Axis, Coupling

__all__ = [
    "ActuatorSpec",
    "AxisSpec",
    "CoupledSpec",
    "JointSpec",
    "build_actuator",
    "build_coupling",
    "build_joint",
    "joint_frame",
]

_N_AXES = {"revolute": 1, "prismatic": 1, "universal": 2, "fixed": 0}
# Limits are angles in [-360, 360] degrees or positions within a metre, much beyond any finger.
_LARGEST_ANGLE_RAD = 2.0 * np.pi
_LARGEST_SLIDE_M = 1.0
_FRACTION = re.compile(r"-?[0-9]{1,3}/[1-9][0-9]{0,2}", re.ASCII)


def _as_number(value: Any) -> Any:
    """A fraction written as text, such as 2/3 or -1/2, as the nearest number; anything else as it is."""
    if isinstance(value, str) and _FRACTION.fullmatch(value):
        return float(Fraction(value))
    return value


Ratio: TypeAlias = Annotated[float, Strict(), Field(ge=-100, le=100), BeforeValidator(_as_number)]


class CoupledSpec(FileModel):
    """`coupled:` of an axis: position = ratio * master + offset (rad or m) or offset_deg."""

    to: Name
    ratio: Ratio = 1.0
    offset: Annotated[float, Strict(), Field(ge=-10, le=10)] = 0.0
    offset_deg: Annotated[float, Strict(), Field(ge=-360, le=360)] = 0.0

    @model_validator(mode="after")
    def _moves(self) -> "CoupledSpec":
        if abs(self.ratio) < 0.01:
            raise ValueError(f"the ratio must not lie in (-0.01, 0.01), as {self.ratio:g} does")
        if self.offset != 0.0 and self.offset_deg != 0.0:
            raise ValueError("has offset (rad or m) or offset_deg, not both")
        return self


class ActuatorSpec(FileModel):
    """`actuator:` of an axis; SI units as in `hands.Actuator`."""

    effort: Positive
    stiffness: Positive
    damping: Positive
    armature: Annotated[float, Strict(), Field(ge=0, le=1e3)]


class AxisSpec(FileModel):
    """One axis of a joint; `direction` in the parent's frame at zero, limits in degrees or SI units."""

    name: Name
    direction: Vector3
    limits: tuple[Finite, Finite] | None = None
    limits_deg: tuple[Finite, Finite] | None = None
    zero_offset_deg: Annotated[float, Strict(), Field(ge=-360, le=360)] = 0.0
    coupled: CoupledSpec | None = None
    actuator: Annotated[Named | Annotated[ActuatorSpec, Inline], NamedOrInline] | None = None

    @model_validator(mode="after")
    def _consistent(self) -> "AxisSpec":
        if (self.limits is None) == (self.limits_deg is None):
            raise ValueError("needs exactly one of limits (rad or m) and limits_deg")
        lower, upper = self.limits or self.limits_deg or (0.0, 0.0)
        if lower > upper:
            raise ValueError(f"the lower limit {lower:g} is above the upper limit {upper:g}")
        if (self.coupled is None) == (self.actuator is None):
            raise ValueError("needs an actuator, or coupled, and not both")
        return self


class JointSpec(FileModel):
    """A joint that carries `child`; its frame at zero has the given axes in the parent's frame.

    The `zero_offset_deg` of an axis turns this frame about the axis: it is the angle that the joint's own
    zero stands off the given frame.
    """

    type: Literal["revolute", "universal", "prismatic", "fixed"]
    parent: Name
    child: Name
    position: Vector3
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)
    axes: Annotated[list[AxisSpec], Field(max_length=2)] = []


def build_joint(
    spec: JointSpec, actuators: dict[str, ActuatorSpec], source: str, field: str
) -> tuple[Array, tuple[Axis, ...]]:
    """Builds a joint from its description in a file.

    Args:
        spec: the description.
        actuators: the actuators that an axis may name.
        source: the file, for error messages.
        field: where in it the description stands.

    Returns:
        T_parent_link0 (4, 4) and the axes, as in `Link`.

    Raises:
        InputError: a wrong number of axes, axes that are zero or not perpendicular, limits out of range.
    """
    if len(spec.axes) != _N_AXES[spec.type]:
        raise InputError(
            source,
            f"{field}.axes",
            f"a {spec.type} joint has {_N_AXES[spec.type]} axes, not {len(spec.axes)}",
        )
    R = joint_frame(spec.x_axis, spec.y_axis, source, field)
    axes = [
        _build_axis(axis, R, spec.type, actuators, source, f"{field}.axes.{k}")
        for k, axis in enumerate(spec.axes)
    ]
    if len(axes) == 2 and abs(axes[0].direction @ axes[1].direction) > 1e-9:
        raise InputError(source, f"{field}.axes", "the two axes of a universal joint must be perpendicular")
    for k, axis in enumerate(spec.axes):
        turn = axis_rotation(axes[k].direction, np.deg2rad(axis.zero_offset_deg))
        R = R @ turn
        # The link's frame turns with the offset; an earlier axis keeps its place in the parent.
        axes[:k] = [replace(earlier, direction=turn.T @ earlier.direction) for earlier in axes[:k]]
    return pose(R, np.array(spec.position)), tuple(axes)


def joint_frame(x_axis: Vector3, y_axis: Vector3, source: str, field: str) -> Array:
    """Rotation (3, 3) whose first columns are the axes of a frame as a file gives them.

    Raises:
        InputError: axes that are not of unit length or not perpendicular.
    """
    x, y = np.array(x_axis), np.array(y_axis)
    for name, axis in (("x_axis", x), ("y_axis", y)):
        if abs(np.linalg.norm(axis) - 1.0) > 1e-6:
            raise InputError(source, f"{field}.{name}", "must be a unit vector")
    if abs(x @ y) > 1e-6:
        raise InputError(source, f"{field}.y_axis", "must be perpendicular to x_axis")
    x /= np.linalg.norm(x)
    y -= (x @ y) * x
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


def _build_axis(
    spec: AxisSpec, R: Array, joint_type: str, actuators: dict[str, ActuatorSpec], source: str, field: str
) -> Axis:
    length = float(np.linalg.norm(spec.direction))
    if length < 1e-6:
        raise InputError(source, f"{field}.direction", "must not be the zero vector")
    slides = joint_type == "prismatic"
    in_degrees = spec.coupled is not None and spec.coupled.offset_deg != 0.0
    if slides and (spec.limits_deg is not None or spec.zero_offset_deg != 0.0 or in_degrees):
        raise InputError(source, field, "a prismatic joint has limits in m, and no angles")
    lower, upper = spec.limits or np.deg2rad(spec.limits_deg or (0.0, 0.0)).tolist()
    largest = _LARGEST_SLIDE_M if slides else _LARGEST_ANGLE_RAD
    if max(-lower, upper) > largest * (1.0 + 1e-12):
        allowed = f"[-{largest:.4g}, {largest:.4g}] {'m' if slides else 'rad'}"
        raise InputError(source, f"{field}.limits", f"must lie in {allowed}; degrees go into limits_deg")
    return Axis(
        spec.name,
        "prismatic" if slides else "revolute",
        R.T @ (np.array(spec.direction) / length),
        lower,
        upper,
        None if spec.coupled is None else build_coupling(spec.coupled),
        _build_actuator(spec.actuator, actuators, source, f"{field}.actuator"),
    )


def build_coupling(spec: CoupledSpec) -> Coupling:
    """Builds a coupling from its description in a file."""
    return Coupling(spec.to, spec.ratio, spec.offset or float(np.deg2rad(spec.offset_deg)))


def build_actuator(spec: ActuatorSpec) -> Actuator:
    """Builds an actuator from its description in a file."""
    return Actuator(spec.effort, spec.stiffness, spec.damping, spec.armature)


def _build_actuator(
    spec: ActuatorSpec | str | None, actuators: dict[str, ActuatorSpec], source: str, field: str
) -> Actuator | None:
    if spec is None:
        return None
    if isinstance(spec, str):
        if spec not in actuators:
            raise UnknownName(source, field, "actuator", spec, actuators)
        spec = actuators[spec]
    return build_actuator(spec)
