"""Hand files that import an MJCF or URDF model: names, servos and regions are added to what the model says.

Link frames are the frames of the model's bodies, shifted (never turned) so that the joints' axes pass through
their origins; of the palm, `palm_frame`. Bodies without joints become part of the body that carries them; a
region on such a body is given in that body's own frame all the same.
"""

import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from ...arrays import Array
from ...errors import InputError, UnknownName
from ...fields import Finite, Name, RegionName, Text, Vector3
from ...files import FileModel
from ...geometry import (
    MassProperties,
    axis_rotation,
    build_region,
    invert,
    pose,
)
from ..hand import Actuator, Axis, Coupling, Hand, HandRegion, Link
from ..hand_file import HandRegionSpec, check_axes, check_limits
from ..joint_file import ActuatorSpec, CoupledSpec, build_actuator, build_coupling, joint_frame
from ..pad_file import PressingSpec
from ..placed import placed_region
from .matter import with_matter
from .model_text import read_model_text
from .model_tree import ModelJoint, ModelTree, compile_model
from .parallel_axes import with_parallel_axes
from .servos import with_nominal_servos

__all__ = ["ImportedHandFile", "import_hand", "import_model", "plain_name"]

# Axes of one body that miss each other by more than this have no common point.
_SAME_POINT_M = 1e-9
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")
# A palm does not move: where the model gives it no mass, any will do. So will it for a link without matter.
_NOMINAL_MASS = MassProperties(1e-3, np.zeros(3), 1e-7 * np.eye(3))


class FrameSpec(FileModel):
    """The palm frame in the frame of the palm's body."""

    position: Vector3 = (0.0, 0.0, 0.0)
    x_axis: Vector3 = (1.0, 0.0, 0.0)
    y_axis: Vector3 = (0.0, 1.0, 0.0)


class ImportedHandFile(PressingSpec):
    """A hand file around an MJCF or URDF model.

    Attributes:
        palm: body of the model that is the palm; what it does not carry is left out.
        link_names: new names of bodies.
        joint_names: new names of joints.
        actuator: servo of joints for which the model has none.
        actuators: servos by (new) name of the joint, before the model's.
        coupled: couplings by (new) name of the joint that follows, before the model's.
        limits: limits in rad or m by (new) name of the joint, before the model's.
        regions: contact regions; found from the model where they are not given.
        mirror: whether the hand is the mirror image of the model.
    """

    name: Name | None = None
    description: Text = ""
    sources: dict[str, Text] = {}
    mirror: bool = False
    model: Annotated[str, Field(alias="import", min_length=1, max_length=1000)]
    palm: Annotated[str, Field(max_length=256)] | None = None
    palm_frame: FrameSpec = FrameSpec()
    link_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    joint_names: Annotated[dict[str, Name], Field(max_length=200)] = {}
    actuator: ActuatorSpec | None = None
    actuators: Annotated[dict[Name, ActuatorSpec], Field(max_length=200)] = {}
    coupled: Annotated[dict[Name, CoupledSpec], Field(max_length=200)] = {}
    limits: Annotated[dict[Name, tuple[Finite, Finite]], Field(max_length=200)] = {}
    regions: Annotated[dict[RegionName, HandRegionSpec], Field(max_length=1000)] | None = None


def import_hand(spec: ImportedHandFile, path: Path, root: Path) -> Hand:
    """Builds a hand from its validated file and the model beside it, with the regions that the file gives.

    Args:
        spec: the file.
        path: of the file, for error messages.
        root: folder below which the model and all of its files lie.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    return import_model(spec, path, root).hand


class Imported(NamedTuple):
    """An imported hand, and how a hand file names its parts.

    Attributes:
        hand: the hand.
        palm: the model's name of the body that is the palm.
        frames: pose T_link_body (4, 4) of the body that gave each link its name, by that name.
    """

    hand: Hand
    palm: str
    frames: dict[str, Array]


def import_model(spec: ImportedHandFile, path: Path, root: Path) -> Imported:
    """`import_hand`, with what it takes to write a hand file about it."""
    tree = compile_model(read_model_text(root / path.name, spec.model, spec.palm), str(path))
    importer = _Importer(spec, str(path), tree)
    return Imported(importer.hand(), importer.palm_name, importer.frames)


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
        self.frames: dict[str, Array] = {}
        self.palm_name = tree.body_names[self._palm]
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
        self.frames = {self._link_names[body]: entry.T_link_body for body, entry in placed.items()}
        links = [
            with_matter(link, _parts(placed, i), self._tree, self._source, is_palm=i == 0)
            for i, link in enumerate(links)
        ]
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
            self._spec.name or plain_name(Path(self._source).stem),
            with_nominal_servos(links, self._tree),
            self._regions(placed),
            self._spec.description,
            dict(self._spec.sources),
            self._never_touching(placed),
            tuple(dict.fromkeys(self._tree.notes)),
            **self._spec.pressing(),
        )
        check_limits(hand, self._source)
        return hand

    def _renamed(self, field: str, new: dict[str, str], known: list[str], kept: list[int]) -> dict[int, str]:
        """Names by number, new or the model's own, no two of them alike."""
        for name in new:
            if name not in [known[i] for i in kept]:
                what = "body" if field == "link_names" else "joint"
                raise UnknownName(self._source, f"{field}.{name}", what, name, [known[i] for i in kept])
        names = {i: new.get(known[i], plain_name(known[i])) for i in kept}
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
        if coupling is None and joint.kind == "revolute":
            self._tree.notes.append(
                f"{name}: the model has no limits for it; 180 degrees both ways were taken"
            )
            return -np.pi, np.pi
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

    def _servo(self, name: str, joint: ModelJoint) -> Actuator | None:
        """The servo that the file or the model gives; None leaves it to `with_nominal_servos`."""
        if name in self._spec.actuators:
            return build_actuator(self._spec.actuators[name])
        if joint.servo is not None:
            return joint.servo
        return None if self._spec.actuator is None else build_actuator(self._spec.actuator)

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
        for name, entry in (self._spec.regions or {}).items():
            if entry.link not in bodies:
                raise UnknownName(self._source, f"regions.{name}.link", "link", entry.link, bodies)
            at = placed[bodies[entry.link]]
            region = build_region(entry, self._source, f"regions.{name}")
            out[name] = HandRegion(name, at.link, placed_region(region, at.T_link_body))
        return out


def _parts(placed: dict[int, _PlacedBody], link: int) -> list[tuple[int, Array]]:
    """The bodies that went into a link, with their poses in it."""
    return [(body, entry.T_link_body) for body, entry in placed.items() if entry.link == link]


def plain_name(name: str) -> str:
    """A model's name with `_` for signs that names here do not have, such as in `robot0:palm`."""
    return _NOT_IN_NAMES.sub("_", name).lstrip(".-")[:64] or "_"
