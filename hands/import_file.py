"""Hand files that import an MJCF or URDF model: names, servos and regions are added to what the model says.

Link frames are the frames of the model's bodies, shifted (never turned) so that the joints' axes pass through
their origins; of the palm, `palm_frame`. Bodies without joints become part of the body that carries them; a
region on such a body is given in that body's own frame all the same.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from ..arrays import Array
from ..errors import InputError, UnknownName
from ..fields import Finite, Name, RegionName, Text, Vector3
from ..files import FileModel
from ..geometry import MassProperties, axis_rotation, build_region, combined_mass, invert, pose
from .hand import Actuator, Axis, Coupling, Hand, HandRegion, Link
from .hand_file import HandRegionSpec, check_axes, check_limits
from .joint_file import ActuatorSpec, CoupledSpec, build_actuator, build_coupling, joint_frame
from .model_text import read_model_text
from .model_tree import ModelJoint, ModelTree, compile_model
from .placed import placed_region, placed_shape

__all__ = ["ImportedHandFile", "import_hand"]

# Axes of one body that miss each other by more than this have no common point.
_SAME_POINT_M = 1e-9
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")
# A palm does not move: where the model gives it no mass, any will do.
_NOMINAL_MASS = MassProperties(1e-3, np.zeros(3), 1e-7 * np.eye(3))


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
    tree = compile_model(read_model_text(path, spec.model), str(path))
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
        self._link_names = self._renamed("link_names", spec.link_names, tree.body_names, self._bodies)
        moving = [joint.name for body in self._bodies[1:] for joint in tree.joints(body)]
        numbers = [tree.joint_names.index(name) for name in moving]
        self._joint_names = self._renamed("joint_names", spec.joint_names, tree.joint_names, numbers)
        self._couplings = self._all_couplings()
        self._check_joint_fields()

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
            raise InputError(self._source, "import", "the model has no geom that collides")
        check_axes(links, self._source)
        hand = Hand(
            self._spec.name,
            tuple(links),
            self._regions(placed),
            self._spec.description,
            dict(self._spec.sources),
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
        out = {}
        for follower, coupling in self._tree.couplings(set(self._bodies[1:])).items():
            if follower not in new or coupling.master not in new:
                raise InputError(
                    self._source,
                    "import",
                    f"joint {follower!r} is coupled to one that the palm does not carry",
                )
            out[new[follower]] = replace(coupling, master=new[coupling.master])
        return out | {name: build_coupling(entry) for name, entry in self._spec.coupled.items()}

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
        limits = self._spec.limits.get(name, joint.limits)
        if limits is None:
            raise InputError(
                self._source, f"limits.{name}", "is required: the model has no limits for this joint"
            )
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
        return replace(link, shapes=shapes, inertia=combined_mass(masses) if masses else link.inertia)

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


def _placed_inertia(inertia: MassProperties, T: Array) -> MassProperties:
    R = T[:3, :3]
    return MassProperties(inertia.mass, R @ inertia.centre + T[:3, 3], R @ inertia.inertia @ R.T)
