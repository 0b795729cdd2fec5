"""Hand files (YAML): their fields, and how a hand is built from them."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ..errors import InputError, UnknownName
from ..files import FileModel, parse, read_yaml
from ..geometry import (
    Box,
    Capsule,
    Hull,
    MassProperties,
    Patch,
    Region,
    RegionSpec,
    Shape,
    Sphere,
    build_region,
    mass_properties,
)
from ..geometry.regions import Vector3
from ..geometry.transforms import axis_rotation, pose
from .hand import Actuator, Axis, Coupling, Hand, HandRegion, Link

__all__ = ["build_hand", "read_hand"]

Array = NDArray[np.float64]
Positive = Annotated[float, Field(gt=0)]
_AXES = {"revolute": 1, "prismatic": 1, "universal": 2, "fixed": 0}


class SphereSpec(FileModel):
    """A ball in the link's frame."""

    centre: Vector3
    radius: Positive


class CapsuleSpec(FileModel):
    """A capsule in the link's frame."""

    start: Vector3
    end: Vector3
    radius: Positive


class BoxSpec(FileModel):
    """A box along the link's axes."""

    centre: Vector3
    half_extents: tuple[Positive, Positive, Positive]


class SectionSpec(FileModel):
    """A rounded cross-section of a hull: at `at` along `along`, an ellipse of exponent `roundness`."""

    at: float
    centre: tuple[float, float] = (0.0, 0.0)
    half: tuple[Positive, Positive]
    roundness: Annotated[float, Field(ge=2, le=20)] = 2.0


class HullSpec(FileModel):
    """The convex hull of points, of cross-sections, and of the surfaces of named regions of the same link."""

    points: list[Vector3] = []
    along: Literal["x", "y", "z"] = "x"
    sections: list[SectionSpec] = []
    regions: list[str] = []


class ShapeSpec(FileModel):
    """One convex shape of a link."""

    sphere: SphereSpec | None = None
    capsule: CapsuleSpec | None = None
    box: BoxSpec | None = None
    hull: HullSpec | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> "ShapeSpec":
        if sum(value is not None for value in (self.sphere, self.capsule, self.box, self.hull)) != 1:
            raise ValueError("needs exactly one of sphere, capsule, box or hull")
        return self


class LinkSpec(FileModel):
    """A link: mass in kg and shapes."""

    name: str
    mass: Positive
    shapes: list[ShapeSpec] = Field(min_length=1)


class CoupledSpec(FileModel):
    """`coupled:` of a joint: position = ratio * master + offset_deg."""

    to: str
    ratio: float = 1.0
    offset_deg: float = 0.0


class ActuatorSpec(FileModel):
    """`actuator:` of an axis; SI units as in `hands.Actuator`."""

    effort: Positive
    stiffness: Positive
    damping: Positive
    armature: Annotated[float, Field(ge=0)]


class AxisSpec(FileModel):
    """One axis of a joint; `direction` in the parent's frame at zero, limits in degrees or SI units."""

    name: str
    direction: Vector3
    limits: tuple[float, float] | None = None
    limits_deg: tuple[float, float] | None = None
    zero_offset_deg: float = 0.0
    coupled: CoupledSpec | None = None
    actuator: ActuatorSpec | str | None = None

    @model_validator(mode="after")
    def _limits(self) -> "AxisSpec":
        if (self.limits is None) == (self.limits_deg is None):
            raise ValueError("needs exactly one of limits (rad or m) and limits_deg")
        lo, hi = self.limits or self.limits_deg or (0.0, 0.0)
        if lo > hi:
            raise ValueError(f"the lower limit {lo:g} is above the upper limit {hi:g}")
        return self


class JointSpec(FileModel):
    """A joint that carries `child`; its frame at zero has the given axes in the parent's frame."""

    type: Literal["revolute", "universal", "prismatic", "fixed"]
    parent: str
    child: str
    position: Vector3
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)
    axes: list[AxisSpec] = []


class HandRegionSpec(RegionSpec):
    """A named region on a link."""

    link: str


class HandFile(FileModel):
    """A hand file."""

    name: str
    description: str = ""
    palm: str = "palm"
    links: list[LinkSpec] = Field(min_length=1)
    joints: list[JointSpec] = []
    actuators: dict[str, ActuatorSpec] = {}
    regions: dict[str, HandRegionSpec] = {}


def read_hand(path: Path) -> Hand:
    """Reads a hand file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return build_hand(parse(HandFile, read_yaml(path), path), str(path))


def build_hand(spec: HandFile, source: str) -> Hand:
    """Builds a hand from its validated file."""
    links = {link.name: link for link in spec.links}
    if len(links) != len(spec.links):
        raise InputError(source, "links", "two links have the same name")
    regions = _build_regions(spec, links, source)
    order = _order_links(spec, links, source)
    built: list[Link] = []
    position = {}
    for joint in order:
        name = joint.child if joint else spec.palm
        i = len(built)
        position[name] = i
        shapes = _build_shapes(links[name], regions, source, f"links.{name}")
        inertia: MassProperties = mass_properties(shapes, links[name].mass)
        if joint is None:
            built.append(Link(name, -1, np.eye(4), (), shapes, inertia))
            continue
        T, axes = _build_joint(joint, spec, source)
        built.append(Link(name, position[joint.parent], T, axes, shapes, inertia))
    _check_couplings(built, source)
    hand_regions = {
        key: HandRegion(key, position[spec.regions[key].link], region) for key, region in regions.items()
    }
    hand = Hand(spec.name, tuple(built), hand_regions, spec.description)
    empty = np.flatnonzero(hand.limits[:, 0] > hand.limits[:, 1])
    if len(empty):
        raise InputError(
            source,
            "joints",
            f"the limits of {hand.independent_names[empty[0]]} and its coupled joints exclude each other",
        )
    return hand


def _order_links(spec: HandFile, links: dict[str, LinkSpec], source: str) -> list[JointSpec | None]:
    """Joints so that parents come first; None stands for the palm."""
    if spec.palm not in links:
        raise UnknownName(source, "palm", "link", spec.palm, links)
    children: dict[str, list[JointSpec]] = {}
    seen = {spec.palm}
    for i, joint in enumerate(spec.joints):
        for field in ("parent", "child"):
            if getattr(joint, field) not in links:
                raise UnknownName(source, f"joints.{i}.{field}", "link", getattr(joint, field), links)
        if joint.child in seen:
            raise InputError(
                source, f"joints.{i}.child", f"{joint.child!r} already hangs on a joint (or is the palm)"
            )
        seen.add(joint.child)
        children.setdefault(joint.parent, []).append(joint)
    # Depth first, so that a finger's joints stand together in a joint vector.
    order = _depth_first(spec.palm, children)
    if len(order) != len(links):
        reached = {joint.child for joint in order if joint} | {spec.palm}
        loose = next(name for name in links if name not in reached)
        raise InputError(source, "joints", f"link {loose!r} is not connected to the palm")
    return order


def _depth_first(palm: str, children: dict[str, list[JointSpec]]) -> list[JointSpec | None]:
    order: list[JointSpec | None] = [None]
    pending = list(reversed(children.get(palm, [])))
    while pending:
        joint = pending.pop()
        order.append(joint)
        pending += reversed(children.get(joint.child, []))
    return order


def _build_joint(joint: JointSpec, spec: HandFile, source: str) -> tuple[Array, tuple[Axis, ...]]:
    field = f"joints.{joint.child}"
    if len(joint.axes) != _AXES[joint.type]:
        raise InputError(
            source,
            f"{field}.axes",
            f"a {joint.type} joint has {_AXES[joint.type]} axes, not {len(joint.axes)}",
        )
    R = _frame(joint, source, field)
    axes: list[Axis] = []
    for k, axis in enumerate(joint.axes):
        length = float(np.linalg.norm(axis.direction))
        if length < 1e-9:
            raise InputError(source, f"{field}.axes.{k}.direction", "must not be the zero vector")
        direction = R.T @ (np.array(axis.direction) / length)
        axes.append(_build_axis(axis, direction, joint.type, spec, source, f"{field}.axes.{k}"))
    if len(axes) == 2 and abs(axes[0].direction @ axes[1].direction) > 1e-9:
        raise InputError(source, f"{field}.axes", "the two axes of a universal joint must be perpendicular")
    # Offsets turn the frame at zero; an earlier axis keeps its place, seen from the turned frame.
    for k in reversed(range(len(axes))):
        turn = axis_rotation(axes[k].direction, np.deg2rad(joint.axes[k].zero_offset_deg))
        for earlier in range(k):
            axes[earlier] = _redirect(axes[earlier], turn.T @ axes[earlier].direction)
    offsets = [
        axis_rotation(R.T @ _normalised(a.direction), np.deg2rad(a.zero_offset_deg)) for a in joint.axes
    ]
    for offset in offsets:
        R = R @ offset
    return pose(R, np.array(joint.position)), tuple(axes)


def _redirect(axis: Axis, direction: Array) -> Axis:
    return Axis(axis.name, axis.kind, direction, axis.lower, axis.upper, axis.coupling, axis.actuator)


def _normalised(v: Vector3) -> Array:
    return np.array(v) / np.linalg.norm(v)


def _frame(joint: JointSpec, source: str, field: str) -> Array:
    x, y = np.array(joint.x_axis), np.array(joint.y_axis)
    if abs(np.linalg.norm(x) - 1) > 1e-6 or abs(np.linalg.norm(y) - 1) > 1e-6 or abs(x @ y) > 1e-6:
        raise InputError(source, f"{field}.x_axis", "x_axis and y_axis must be perpendicular unit vectors")
    x = x / np.linalg.norm(x)
    y = y - (x @ y) * x
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


def _build_axis(
    axis: AxisSpec, direction: Array, type_: str, spec: HandFile, source: str, field: str
) -> Axis:
    limits = axis.limits if axis.limits is not None else tuple(np.deg2rad(axis.limits_deg or (0.0, 0.0)))
    coupling = axis.coupled and Coupling(
        axis.coupled.to, axis.coupled.ratio, float(np.deg2rad(axis.coupled.offset_deg))
    )
    if coupling is not None and coupling.ratio == 0.0:
        raise InputError(source, f"{field}.coupled.ratio", "must not be zero")
    actuator = axis.actuator
    if isinstance(actuator, str):
        if actuator not in spec.actuators:
            raise UnknownName(source, f"{field}.actuator", "actuator", actuator, spec.actuators)
        actuator = spec.actuators[actuator]
    if (coupling is None) == (actuator is None):
        raise InputError(source, field, "needs an actuator, or coupled, and not both")
    servo = actuator and Actuator(actuator.effort, actuator.stiffness, actuator.damping, actuator.armature)
    kind: Literal["revolute", "prismatic"] = "prismatic" if type_ == "prismatic" else "revolute"
    return Axis(
        axis.name, kind, direction, float(limits[0]), float(limits[1]), coupling or None, servo or None
    )


def _check_couplings(links: list[Link], source: str) -> None:
    axes = [axis for link in links for axis in link.axes]
    by_name = {axis.name: axis for axis in axes}
    if len(by_name) != len(axes):
        raise InputError(source, "joints", "two axes have the same name")
    for axis in axes:
        seen = {axis.name}
        current = axis
        while current.coupling is not None:
            if current.coupling.master not in by_name:
                raise UnknownName(
                    source, f"joints.{axis.name}.coupled.to", "joint", current.coupling.master, by_name
                )
            current = by_name[current.coupling.master]
            if current.name in seen:
                raise InputError(source, f"joints.{axis.name}.coupled.to", "the couplings run in a circle")
            seen.add(current.name)


def _build_regions(spec: HandFile, links: dict[str, LinkSpec], source: str) -> dict[str, Region]:
    regions: dict[str, Region] = {}
    for key, region in spec.regions.items():
        if region.link not in links:
            raise UnknownName(source, f"regions.{key}.link", "link", region.link, links)
        regions[key] = build_region(region, source, f"regions.{key}")
    return regions


def _build_shapes(link: LinkSpec, regions: dict[str, Region], source: str, field: str) -> tuple[Shape, ...]:
    return tuple(
        _build_shape(shape, regions, source, f"{field}.shapes.{i}") for i, shape in enumerate(link.shapes)
    )


def _build_shape(shape: ShapeSpec, regions: dict[str, Region], source: str, field: str) -> Shape:
    if shape.sphere is not None:
        return Sphere(np.array(shape.sphere.centre), shape.sphere.radius)
    if shape.capsule is not None:
        if np.allclose(shape.capsule.start, shape.capsule.end, atol=1e-9):
            raise InputError(source, f"{field}.capsule", "start and end must differ (use a sphere)")
        return Capsule(np.array(shape.capsule.start), np.array(shape.capsule.end), shape.capsule.radius)
    if shape.box is not None:
        return Box(pose(np.eye(3), np.array(shape.box.centre)), np.array(shape.box.half_extents))
    assert shape.hull is not None
    return _build_hull(shape.hull, regions, source, f"{field}.hull")


def _build_hull(hull: HullSpec, regions: dict[str, Region], source: str, field: str) -> Hull:
    clouds = [np.array(hull.points).reshape(-1, 3)]
    clouds += [_section_points(section, hull.along) for section in hull.sections]
    patches = {key: region.patch for key, region in regions.items() if isinstance(region, Patch)}
    u = np.linspace(0.0, 1.0, 13)
    for name in hull.regions:
        if name not in patches:
            raise UnknownName(source, f"{field}.regions", "patch", name, patches)
        clouds.append(patches[name].evaluate(u[:, None], u[None, :]).reshape(-1, 3))
    points = np.concatenate(clouds)
    if len(points) < 4 or np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-6) < 3:
        raise InputError(source, field, "needs at least four points that are not all in one plane")
    return Hull.from_points(points)


def _section_points(section: SectionSpec, along: str) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    exponent = 2.0 / section.roundness
    ring = np.column_stack(
        [np.sign(f) * np.abs(f) ** exponent for f in (np.cos(angle), np.sin(angle))]
    ) * np.array(section.half) + np.array(section.centre)
    axis = "xyz".index(along)
    points = np.full((len(angle), 3), section.at)
    points[:, [i for i in range(3) if i != axis]] = ring
    return points
