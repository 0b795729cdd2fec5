"""Hand files that import an MJCF or URDF model: names, servos and regions are added to what the model says.

Link frames are the frames of the model's bodies, shifted (never turned) so that the joints' axes pass through
their origins; of the palm, `palm_frame`. Bodies without joints become part of the body that carries them; a
region on such a body is given in that body's own frame all the same.
"""

import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from ..arrays import Array
from ..errors import InputError, UnknownName
from ..fields import Finite, Name, RegionName, Text, Vector3
from ..files import FileModel
from ..geometry import (
    MassProperties,
    axis_rotation,
    build_region,
    combined_mass,
    invert,
    mass_properties,
    pose,
    shape_mesh,
)
from .hand import Actuator, Axis, Coupling, Hand, HandRegion, Link
from .hand_file import HandRegionSpec, check_axes, check_limits
from .joint_file import ActuatorSpec, CoupledSpec, build_actuator, build_coupling, joint_frame
from .model_text import read_model_text
from .model_tree import ModelJoint, ModelTree, compile_model
from .parallel_axes import with_parallel_axes
from .placed import placed_region, placed_shape

__all__ = ["ImportedHandFile", "import_hand"]

# Axes of one body that miss each other by more than this have no common point.
_SAME_POINT_M = 1e-9
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")
# A palm does not move: where the model gives it no mass, any will do. So will it for a link without matter.
_NOMINAL_MASS = MassProperties(1e-3, np.zeros(3), 1e-7 * np.eye(3))
# kg/m^3 of links to which the model gives no mass; MuJoCo takes the same for its geoms.
_DENSITY = 1000.0
_LEAST_MASS_KG = 1e-6
# The least radius of gyration that a link may have.
_LEAST_GYRATION_M = 1e-4
# Beyond these, figures are no hand's: most often millimetres were taken for metres.
_LARGEST_LENGTH_M = 10.0
_LARGEST_MASS_KG = 1e3
_LARGEST_SERVO = 1e9


class FrameSpec(FileModel):
    """The palm frame in the frame of the palm's body."""

    position: Vector3 = (0.0, 0.0, 0.0)
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)


class ImportedHandFile(FileModel):
    """A hand file around an MJCF or URDF model.

    Attributes:
        palm: body of the model that is the palm; what it does not carry is left out.
        link_names: new names of bodies.
        joint_names: new names of joints.
        actuator: servo of joints for which the model has none.
        actuators: servos by (new) name of the joint, before the model's.
        coupled: couplings by (new) name of the joint that follows, before the model's.
        limits: limits in rad or m by (new) name of the joint, before the model's.
    """

    name: Name
    description: Text = ""
    sources: dict[str, Text] = {}
    model: Annotated[str, Field(alias="import", min_length=1, max_length=1000)]
    palm: Annotated[str, Field(max_length=256)] | None = None
    palm_frame: FrameSpec = FrameSpec()
    link_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    joint_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    actuator: ActuatorSpec | None = None
    actuators: Annotated[dict[Name, ActuatorSpec], Field(max_length=200)] = {}
    coupled: Annotated[dict[Name, CoupledSpec], Field(max_length=200)] = {}
    limits: Annotated[dict[Name, tuple[Finite, Finite]], Field(max_length=200)] = {}
    regions: Annotated[dict[RegionName, HandRegionSpec], Field(max_length=1000)] = {}


def import_hand(spec: ImportedHandFile, path: Path) -> Hand:
    """Builds a hand from its validated file and the model beside it.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    tree = compile_model(read_model_text(path, spec.model, spec.palm), str(path))
    return _Importer(spec, str(path), tree).hand()


@dataclass
class _PlacedBody:
    """Where a body of the model went: a link, and the body's pose in that link's frame."""

    link: int
    T_link_body: Array


class _Importer:
    """Turns the bodies of a model into links."""

    def __init__(self, spec: ImportedHandFile, source: str, tree: ModelTree):
        self._spec = spec
        self._source = source
        self._tree = tree
        self._palm = tree.palm(spec.palm)
        self._bodies = tree.carried(self._palm)
        tree.collide_as_drawn(self._bodies)
        self._link_names = self._renamed("link_names", spec.link_names, tree.body_names, self._bodies)
        moving = [joint.name for body in self._bodies[1:] for joint in tree.joints(body)]
        numbers = [tree.joint_names.index(name) for name in moving]
        self._joint_names = self._renamed("joint_names", spec.joint_names, tree.joint_names, numbers)
        self._check_joint_fields()
        self._couplings = self._all_couplings()

    def hand(self) -> Hand:
        """The hand."""
        links: list[Link] = []
        placed: dict[int, _PlacedBody] = {}
        for body in self._bodies:
            joints = self._tree.joints(body) if body != self._palm else []
            if body == self._palm:
                placed[body] = _PlacedBody(0, invert(self._T_body_palm()))
                links.append(Link(self._link_names[body], -1, np.eye(4), (), (), _NOMINAL_MASS))
                continue
            parent = placed[self._tree.parents[body]]
            T = parent.T_link_body @ self._tree.T_parent_body(body)
            if joints:
                anchor = self._common_anchor(body, joints)
                T0, axes = self._axes(T @ pose(np.eye(3), anchor), joints)
                placed[body] = _PlacedBody(len(links), pose(np.eye(3), -anchor))
                links.append(Link(self._link_names[body], parent.link, T0, axes, (), _NOMINAL_MASS))
            else:
                placed[body] = _PlacedBody(parent.link, T)
        links = [self._with_matter(i, link, placed) for i, link in enumerate(links)]
        if not any(link.shapes for link in links):
            raise InputError(
                self._source,
                "import",
                "the palm carries no geom, neither one that collides nor one that is drawn",
            )
        links, mended = with_parallel_axes(links)
        self._tree.notes += mended
        check_axes(links, self._source)
        hand = Hand(
            self._spec.name,
            tuple(links),
            self._regions(placed),
            self._spec.description,
            dict(self._spec.sources),
            self._never_touching(placed),
            tuple(dict.fromkeys(self._tree.notes)),
        )
        check_limits(hand, self._source)
        return hand

    def _renamed(self, field: str, new: dict[str, str], known: list[str], kept: list[int]) -> dict[int, str]:
        """Names by number, new or the model's own, no two of them alike."""
        for name in new:
            if name not in [known[i] for i in kept]:
                what = "body" if field == "link_names" else "joint"
                raise UnknownName(self._source, f"{field}.{name}", what, name, [known[i] for i in kept])
        names = {i: new.get(known[i], _plain(known[i])) for i in kept}
        if field == "link_names" and self._palm == 0 and "world" not in new:
            names[0] = "palm"
        for i, name in names.items():
            if name == "world" or list(names.values()).count(name) > 1:
                raise InputError(
                    self._source,
                    f"{field}.{known[i]}",
                    f"{name!r} is reserved or stands twice: give it a new name",
                )
        return names

    def _all_couplings(self) -> dict[str, Coupling]:
        """Couplings by new names, the file's before the model's."""
        new = {self._tree.joint_names[i]: name for i, name in self._joint_names.items()}
        own = {name: build_coupling(entry) for name, entry in self._spec.coupled.items()}
        given = {old for old, name in new.items() if name in own}
        out = {}
        for follower, coupling in self._tree.couplings.of_joints(set(self._bodies[1:]), given).items():
            if follower not in new or coupling.master not in new:
                raise InputError(
                    self._source,
                    "import",
                    f"joint {follower!r} is coupled to {coupling.master!r}, which the palm does not carry; "
                    f"say in coupled how {follower!r} follows a joint of the hand",
                )
            out[new[follower]] = replace(coupling, master=new[coupling.master])
        for name, coupling in own.items():
            # The file may turn a coupling of the model round.
            turned = out.get(coupling.master)
            if turned is not None and turned.master == name:
                del out[coupling.master]
        out |= own
        coupled = {old for old, name in new.items() if name in out}
        self._tree.notes += self._tree.couplings.tendon_notes(set(self._bodies[1:]), coupled)
        return out

    def _check_joint_fields(self) -> None:
        known = list(self._joint_names.values())
        for field in ("actuators", "coupled", "limits"):
            for name in getattr(self._spec, field):
                if name not in known:
                    raise UnknownName(self._source, f"{field}.{name}", "joint", name, known)
        for name, (lower, upper) in self._spec.limits.items():
            if lower > upper:
                raise InputError(
                    self._source,
                    f"limits.{name}",
                    f"the lower limit {lower:g} is above the upper limit {upper:g}",
                )

    def _T_body_palm(self) -> Array:
        frame = self._spec.palm_frame
        R = joint_frame(frame.x_axis, frame.y_axis, self._source, "palm_frame")
        return pose(R, np.array(frame.position))

    def _common_anchor(self, body: int, joints: list[ModelJoint]) -> Array:
        """A point (3,) that the axes of all hinges of a body pass through, in the body's frame."""
        hinges = [joint for joint in joints if joint.kind == "revolute"]
        if not hinges:
            return np.zeros(3)
        across = [np.eye(3) - np.outer(joint.axis, joint.axis) for joint in hinges]
        # Near the first anchor, of all points of a common axis.
        A = np.vstack(across)
        b = np.concatenate(
            [P @ (joint.anchor - hinges[0].anchor) for P, joint in zip(across, hinges, strict=True)]
        )
        point = np.linalg.lstsq(A, b, rcond=1e-9)[0]
        if np.abs(A @ point - b).max() > _SAME_POINT_M:
            raise InputError(
                self._source,
                f"import: body {self._tree.body_names[body]}",
                "has hinges whose axes don't cross: put a body between them",
            )
        return point + hinges[0].anchor

    def _axes(self, T: Array, joints: list[ModelJoint]) -> tuple[Array, tuple[Axis, ...]]:
        """T_parent_link0 (4, 4) and axes, from the link's pose `T` with all joints at the model's zero."""
        axes: list[Axis] = []
        for joint in joints:
            axes.append(self._axis(joint))
            if joint.kind == "prismatic":
                if joint.zero != 0.0 and len(axes) > 1:
                    raise InputError(
                        self._source,
                        f"import: joint {joint.name}",
                        "has a ref behind another joint of its body",
                    )
                T = T @ pose(np.eye(3), -joint.zero * joint.axis)
            else:
                # The joint's own zero; an earlier axis keeps its place in the parent.
                turn = axis_rotation(joint.axis, -joint.zero)
                T = T @ pose(turn, np.zeros(3))
                axes[:-1] = [replace(earlier, direction=turn.T @ earlier.direction) for earlier in axes[:-1]]
        return T, tuple(axes)

    def _axis(self, joint: ModelJoint) -> Axis:
        name = self._joint_names[self._tree.joint_names.index(joint.name)]
        limits = self._limits(name)
        largest = 2.0 * np.pi if joint.kind == "revolute" else 1.0
        if max(-limits[0], limits[1]) > largest * (1.0 + 1e-12) or limits[0] > limits[1]:
            unit = "rad" if joint.kind == "revolute" else "m"
            raise InputError(
                self._source,
                f"limits.{name}",
                f"must lie in [-{largest:.4g}, {largest:.4g}] {unit}, not {limits}",
            )
        coupling = self._couplings.get(name)
        servo = None if coupling else self._servo(name, joint)
        return Axis(name, joint.kind, joint.axis, limits[0], limits[1], coupling, servo)

    def _limits(self, name: str, seen: frozenset[str] = frozenset()) -> tuple[float, float]:
        """Limits of a joint: the file's, the model's, or for one that follows, those that its master sets."""
        joint, coupling = self._joints[name], self._couplings.get(name)
        limits = self._spec.limits.get(name, joint.limits)
        if limits is not None:
            return limits
        if coupling is None or coupling.master in seen or coupling.master not in self._joints:
            raise InputError(
                self._source, f"limits.{name}", "is required: the model has no limits for this joint"
            )
        ends = [
            coupling.ratio * end + coupling.offset for end in self._limits(coupling.master, seen | {name})
        ]
        return min(ends), max(ends)

    @cached_property
    def _joints(self) -> dict[str, ModelJoint]:
        """The joints of the hand by their new names."""
        joints = [joint for body in self._bodies[1:] for joint in self._tree.joints(body)]
        return {self._joint_names[self._tree.joint_names.index(joint.name)]: joint for joint in joints}

    def _servo(self, name: str, joint: ModelJoint) -> Actuator:
        if name in self._spec.actuators:
            return build_actuator(self._spec.actuators[name])
        if joint.servo is not None:
            return joint.servo
        if self._spec.actuator is None:
            raise InputError(
                self._source,
                "actuator",
                f"is required: for {name!r} the model has no damped position actuator with an effort limit",
            )
        return build_actuator(self._spec.actuator)

    def _with_matter(self, number: int, link: Link, placed: dict[int, _PlacedBody]) -> Link:
        """The link with the shapes and masses of the bodies that went into it."""
        parts = [(body, entry.T_link_body) for body, entry in placed.items() if entry.link == number]
        shapes = tuple(placed_shape(shape, T) for body, T in parts for shape in self._tree.shapes(body))
        masses = [_placed_inertia(self._tree.inertia(body), T) for body, T in parts]
        masses = [mass for mass in masses if mass.mass > 0.0]
        inertia = combined_mass(masses) if masses else link.inertia
        if (not masses or inertia.mass < _LEAST_MASS_KG) and number > 0:
            inertia = link.inertia
            if shapes:
                volume = sum(abs(shape_mesh(shape).volume) for shape in shapes)
                inertia = mass_properties(shapes, max(_DENSITY * volume, _LEAST_MASS_KG))
            self._tree.notes.append(
                f"{link.name}: the model gives it no mass; {inertia.mass:.2g} kg was taken"
                + (f", {_DENSITY:g} kg/m^3" if shapes else "")
            )
        link = replace(link, shapes=shapes, inertia=_sound(inertia))
        self._check_sane(link)
        return link

    def _check_sane(self, link: Link) -> None:
        """Refuses figures that are no hand's.

        Raises:
            InputError: naming the link and what is allowed.
        """
        field = f"import: body {link.name}"
        lengths = [link.T_parent_link0[:3, 3], link.inertia.centre]
        lengths += [corner for shape in link.shapes for corner in shape_mesh(shape).bounds]
        largest = float(np.abs(lengths).max())
        if not largest <= _LARGEST_LENGTH_M:
            raise InputError(
                self._source,
                field,
                f"reaches {largest:.3g} m, and no hand is larger than {_LARGEST_LENGTH_M:g} m; is it in mm "
                "(a mesh then needs scale 0.001)?",
            )
        if not link.inertia.mass <= _LARGEST_MASS_KG:
            raise InputError(
                self._source,
                field,
                f"weighs {link.inertia.mass:.3g} kg; at most {_LARGEST_MASS_KG:g} kg is allowed",
            )
        for axis in link.axes:
            if axis.coupling is not None and not 0.01 <= abs(axis.coupling.ratio) <= 100.0:
                raise InputError(
                    self._source,
                    f"import: joint {axis.name}",
                    f"follows {axis.coupling.master!r} by the ratio {axis.coupling.ratio:g}; "
                    "from 0.01 to 100 or from -100 to -0.01 is allowed",
                )
            if axis.coupling is not None and not abs(axis.coupling.offset) <= 10.0:
                raise InputError(
                    self._source,
                    f"import: joint {axis.name}",
                    f"follows with the offset {axis.coupling.offset:g}; -10 to 10 (rad or m) is allowed",
                )
            servo = axis.actuator
            if (
                servo is not None
                and not max(servo.effort, servo.stiffness, servo.damping, servo.armature) <= _LARGEST_SERVO
            ):
                raise InputError(
                    self._source, f"actuators.{axis.name}", f"has figures beyond {_LARGEST_SERVO:g}: {servo}"
                )

    def _never_touching(self, placed: dict[int, _PlacedBody]) -> tuple[tuple[int, int], ...]:
        """Pairs of links whose bodies with shapes are kept apart by the model, all of them."""
        solid = [body for body in placed if self._tree.shapes(body)]
        apart = set(self._tree.never_touching(solid))
        every: dict[tuple[int, int], bool] = {}
        for i, a in enumerate(solid):
            for b in solid[i + 1 :]:
                first, second = sorted((placed[a].link, placed[b].link))
                if first != second:
                    key = (first, second)
                    every[key] = every.get(key, True) and (a, b) in apart
        pairs = tuple(sorted(pair for pair, kept_apart in every.items() if kept_apart))
        if pairs:
            self._tree.notes.append(
                f"{len(pairs)} of {len(every)} pairs of links never touch, by the model's excludes and bits"
            )
        return pairs

    def _regions(self, placed: dict[int, _PlacedBody]) -> dict[str, HandRegion]:
        bodies = {name: body for body, name in self._link_names.items()}
        out = {}
        for name, entry in self._spec.regions.items():
            if entry.link not in bodies:
                raise UnknownName(self._source, f"regions.{name}.link", "link", entry.link, bodies)
            at = placed[bodies[entry.link]]
            region = build_region(entry, self._source, f"regions.{name}")
            out[name] = HandRegion(name, at.link, placed_region(region, at.T_link_body))
        return out


def _plain(name: str) -> str:
    """A model's name with `_` for signs that names here do not have, such as in `robot0:palm`."""
    return _NOT_IN_NAMES.sub("_", name).lstrip(".-")[:64] or "_"


def _sound(inertia: MassProperties) -> MassProperties:
    """The mass with an inertia that a body can have: moments above zero, none larger than the others' sum."""
    moments, axes = np.linalg.eigh(0.5 * (inertia.inertia + inertia.inertia.T))
    least = inertia.mass * _LEAST_GYRATION_M**2
    if moments.min() >= least and moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-9):
        return inertia
    moments = np.maximum(moments, least)
    if moments[2] > moments[0] + moments[1]:
        moments[:] = moments.mean()
    return MassProperties(inertia.mass, inertia.centre, axes @ np.diag(moments) @ axes.T)


def _placed_inertia(inertia: MassProperties, T: Array) -> MassProperties:
    R = T[:3, :3]
    return MassProperties(inertia.mass, R @ inertia.centre + T[:3, 3], R @ inertia.inertia @ R.T)
