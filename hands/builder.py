"""Hands built from finger structures: a short file becomes the links, joints and regions of a hand file.

A finger's links are `<finger>_1`, `<finger>_2`, ... from the palm to the tip. Joint k is called like the link
that it carries; the two axes of a universal joint are `<finger>_<k>_abduction` and `<finger>_<k>_flexion`.
Link frames: x along the phalanx, y lateral, z out of the pad; abduction turns about z, flexion about -y.
"""

from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias

import numpy as np
from pydantic import Field, Strict, model_validator

from ..base.files.fields import Extent, Mass, Name, RegionName, Text, Vector3
from ..base.files.file_model import FileModel, parse
from ..errors import InputError, UnknownName
from .hand_file import HandFile, HandRegionSpec
from .joint_file import ActuatorSpec
from .pad_file import PressingSpec
from .shape_file import ShapeSpec
from .structure import FingerJoint, parse_structure

__all__ = ["BuiltHandFile", "build_file"]

_PALM = "palm"
_ABDUCTION, _FLEXION = (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)
_ABDUCTION_LIMITS_DEG, _FLEXION_LIMITS_DEG = (-15.0, 15.0), (0.0, 90.0)
# The pad bulges out of the round phalanx by this share of its radius, so that it lies on the link's hull.
_PAD_BULGE = 0.015
_PAD_HALF_WIDTH = 0.7
_PAD_ENDS = (0.2, 0.85)
_KNUCKLE = 0.8

Degrees: TypeAlias = Annotated[float, Strict(), Field(ge=-360, le=360)]
Length: TypeAlias = Annotated[float, Strict(), Field(ge=0, le=1)]


class PalmSpec(FileModel):
    """The palm: mass in kg and shapes in the palm frame."""

    mass: Mass
    shapes: Annotated[list[ShapeSpec], Field(min_length=1, max_length=100)]


class MountSpec(FileModel):
    """Where a joint sits on the link before it, where that is not straight ahead."""

    position: Vector3
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)


class FingerJointSpec(FileModel):
    """What is special about a joint of a finger.

    Attributes:
        joint: its number in the structure, from 1.
        axes: directions in the link's frame, where they are not the usual ones.
        limits_deg: limits of its axes, where they are not the usual ones.
        mount: where it sits on the link before it, where that is not straight ahead.
    """

    joint: Annotated[int, Strict(), Field(ge=1, le=8)]
    axes: list[Vector3] | None = None
    limits_deg: list[tuple[Degrees, Degrees]] | None = None
    mount: MountSpec | None = None


class FingerSpec(FileModel):
    """A finger; `position`, `x_axis` and `y_axis` place its first own joint, in the palm or on `base`.

    Attributes:
        structure: as in `parse_structure`.
        base: another finger, whose first joint is this finger's first joint too.
        lengths: m, one per own joint: from the joint to the next, the last one to the tip.
        radius: m, of all phalanges.
        joints: what is special about some of them.
    """

    structure: Annotated[str, Field(max_length=40)]
    base: Name | None = None
    position: Vector3
    x_axis: Vector3 = (0.0, 0.0, 1.0)
    y_axis: Vector3 = (0.0, -1.0, 0.0)
    lengths: Annotated[list[Length], Field(min_length=1, max_length=8)]
    radius: Extent
    joints: Annotated[list[FingerJointSpec], Field(max_length=8)] = []

    @model_validator(mode="after")
    def _consistent(self) -> "FingerSpec":
        joints = parse_structure(self.structure)
        first = 1 if self.base is None else 2
        own = len(joints) - first + 1
        if own < 1:
            raise ValueError("a finger with a base has at least one joint of its own")
        if any(joint.leader is not None and joint.leader < first - 1 for joint in joints):
            raise ValueError("joints can't turn together with the joint of the base")
        if len(self.lengths) != own:
            raise ValueError(f"lengths has {len(self.lengths)} entries, not {own}, one per joint of its own")
        if self.lengths[-1] < 2.0 * self.radius:
            raise ValueError(f"the last length must be at least twice the radius, {2.0 * self.radius:g} m")
        numbers = [entry.joint for entry in self.joints]
        if len(set(numbers)) < len(numbers):
            raise ValueError("joints has the same joint twice")
        for entry in self.joints:
            _check_joint(entry, joints, first)
        return self

    def special(self, k: int) -> FingerJointSpec:
        """What is special about joint number k."""
        return next((entry for entry in self.joints if entry.joint == k), FingerJointSpec(joint=k))


def _check_joint(entry: FingerJointSpec, joints: tuple[FingerJoint, ...], first: int) -> None:
    """Raises ValueError unless the entry fits the structure, whose own joints start with number `first`."""
    k = entry.joint
    if not first <= k <= len(joints):
        raise ValueError(f"joints has joint {k}, but the finger's own are {first} to {len(joints)}")
    if entry.mount is not None and k == first:
        raise ValueError(
            f"joint {k} sits where position, x_axis and y_axis of the finger say: it has no mount"
        )
    for name, values in (("axes", entry.axes), ("limits_deg", entry.limits_deg)):
        if values is not None and len(values) != joints[k - 1].n_axes:
            raise ValueError(f"{name} of joint {k} has {len(values)} entries, not {joints[k - 1].n_axes}")
    if any(lower > upper for lower, upper in entry.limits_deg or []):
        raise ValueError(f"limits_deg of joint {k} has a lower limit above its upper limit")


class BuiltHandFile(PressingSpec):
    """A hand file that is built from the structures of its fingers."""

    name: Name | None = None
    description: Text = ""
    sources: dict[str, Text] = {}
    mirror: bool = False
    palm: PalmSpec
    density: Annotated[float, Strict(), Field(ge=10, le=20_000)]
    actuator: ActuatorSpec
    fingers: Annotated[dict[Name, FingerSpec], Field(min_length=1, max_length=10)]
    regions: Annotated[dict[RegionName, HandRegionSpec], Field(max_length=1000)] = {}


def build_file(spec: BuiltHandFile, source: str) -> HandFile:
    """Writes out the links, joints and regions of the fingers.

    Raises:
        InputError: a base that does not fit, a region that stands twice.
    """
    links: list[Any] = [{"name": _PALM, **spec.palm.model_dump(exclude_none=True)}]
    joints: list[Any] = []
    regions = {name: region.model_dump(exclude_none=True) for name, region in spec.regions.items()}
    for name, finger in spec.fingers.items():
        _check_base(spec, name, finger, source)
        built = _Finger(name, finger, parse_structure(finger.structure))
        links += [built.link(k, spec.density) for k in built.own]
        joints += [built.joint(k) for k in built.own]
        for region, entry in built.regions().items():
            if region in regions:
                raise InputError(source, f"regions.{region}", "is built from the finger: use another name")
            regions[region] = entry
    return parse(
        HandFile,
        {
            "name": spec.name,
            "description": spec.description,
            "sources": spec.sources,
            "palm": _PALM,
            "links": links,
            "joints": joints,
            "actuators": {"servo": spec.actuator.model_dump()},
            "regions": regions,
            **spec.model_dump(include=set(PressingSpec.model_fields)),
        },
        source,
    )


def _check_base(spec: BuiltHandFile, name: str, finger: FingerSpec, source: str) -> None:
    if finger.base is None:
        return
    others = [other for other, entry in spec.fingers.items() if other != name and entry.base is None]
    field = f"fingers.{name}.base"
    if finger.base not in others:
        raise UnknownName(source, field, "finger with a first joint of its own", finger.base, others)
    first = parse_structure(spec.fingers[finger.base].structure)[0]
    if first.kind != parse_structure(finger.structure)[0].kind:
        raise InputError(
            source, field, f"{finger.base!r} starts with {first.kind}: so must {finger.structure!r}"
        )


@dataclass(frozen=True)
class _Finger:
    """A finger whose links, joints and regions are written out, by the numbers of its joints from 1."""

    name: str
    spec: FingerSpec
    joints: tuple[FingerJoint, ...]

    @property
    def own(self) -> range:
        """Numbers of the joints that are not the base's."""
        return range(1 if self.spec.base is None else 2, len(self.joints) + 1)

    def joint(self, k: int) -> dict[str, Any]:
        """Joint number k as in a hand file."""
        mount = self._mount(k)
        x, y = np.array(mount.x_axis), np.array(mount.y_axis)
        R = np.column_stack([x, y, np.cross(x, y)])
        kind = self.joints[k - 1].kind
        usual = [_ABDUCTION, _FLEXION] if kind == "U" else [_FLEXION]
        usual_deg = [_ABDUCTION_LIMITS_DEG, _FLEXION_LIMITS_DEG] if kind == "U" else [_FLEXION_LIMITS_DEG]
        special = self.spec.special(k)
        directions, limits = special.axes or usual, special.limits_deg or usual_deg
        axes = [
            {"name": name, "direction": (R @ direction).tolist(), "limits_deg": degrees}
            for name, direction, degrees in zip(self._axis_names(k), directions, limits, strict=True)
        ]
        leader = self.joints[k - 1].leader
        for axis in axes:
            axis["actuator"] = "servo"
        if leader is not None:
            del axes[-1]["actuator"]
            axes[-1]["coupled"] = {"to": self._axis_names(leader + 1)[-1]}
        return {
            "type": "universal" if kind == "U" else "revolute",
            "parent": self._parent(k),
            "child": self._link_name(k),
            **mount.model_dump(),
            "axes": axes,
        }

    def _mount(self, k: int) -> MountSpec:
        if k == self.own[0]:
            return MountSpec(position=self.spec.position, x_axis=self.spec.x_axis, y_axis=self.spec.y_axis)
        return self.spec.special(k).mount or MountSpec(position=(self._length(k - 1), 0.0, 0.0))

    def _axis_names(self, k: int) -> list[str]:
        name = self._link_name(k)
        return [f"{name}_abduction", f"{name}_flexion"] if self.joints[k - 1].kind == "U" else [name]

    def _parent(self, k: int) -> str:
        if k > self.own[0]:
            return self._link_name(k - 1)
        return _PALM if self.spec.base is None else f"{self.spec.base}_1"

    def _link_name(self, k: int) -> str:
        return f"{self.name}_{k}"

    def _length(self, k: int) -> float:
        return self.spec.lengths[k - self.own[0]]

    def link(self, k: int, density: float) -> dict[str, Any]:
        """Link number k as in a hand file: a capsule to the next joint, or the finger's end."""
        r = self.spec.radius
        end = (self._length(k), 0.0, 0.0) if k == self.own[-1] else self._mount(k + 1).position
        length = float(np.linalg.norm(end))
        if k == self.own[-1]:
            shapes = self._end_shapes()
        elif length < r:
            shapes = [{"sphere": {"centre": [0.0, 0.0, 0.0], "radius": _KNUCKLE * r}}]
        else:
            shapes = [{"capsule": {"start": [0.0, 0.0, 0.0], "end": list(end), "radius": r}}]
        mass = density * np.pi * r**2 * (length + 4.0 / 3.0 * r)
        return {"name": self._link_name(k), "mass": float(mass), "shapes": shapes}

    @property
    def _ball(self) -> float:
        """Where along the last link the ball of the fingertip has its centre."""
        return self.spec.lengths[-1] - self.spec.radius

    def _end_shapes(self) -> list[Any]:
        r = self.spec.radius
        round_ = r * (1.0 - _PAD_BULGE)
        sections = [
            {"at": -0.7 * r, "half": [0.6 * r, 0.6 * r]},
            {"at": 0.0, "half": [round_, round_]},
            {"at": self._ball, "half": [round_, round_]},
        ]
        return [
            {"hull": {"along": "x", "sections": sections, "regions": [f"{self.name}/pad"]}},
            {"sphere": {"centre": [self._ball, 0.0, 0.0], "radius": r}},
        ]

    def regions(self) -> dict[str, Any]:
        """`<finger>/tip`, part of the fingertip's ball, and `<finger>/pad`, a patch on the last phalanx."""
        r, w = self.spec.radius, _PAD_HALF_WIDTH * self.spec.radius
        edge = float(np.sqrt(r**2 - w**2))
        rows = [
            [[x, -w, edge], [x, 0.0, 2.0 * r - edge], [x, w, edge]]
            for x in (share * self._ball for share in _PAD_ENDS)
        ]
        cap = {"centre": [self._ball, 0.0, 0.0], "radius": r, "axis": [1.0, 0.0, 1.0], "half_angle_deg": 45.0}
        link = self._link_name(self.own[-1])
        return {
            f"{self.name}/tip": {"link": link, "cap": cap},
            f"{self.name}/pad": {"link": link, "bezier": rows},
        }
