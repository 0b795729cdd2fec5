"""Hand files (YAML): their fields, and how a hand is built from them."""

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from ..base.files.fields import Mass, Name, RegionName, Text, plain_name
from ..base.files.file_model import FileModel
from ..errors import InputError, UnknownName
from ..geometry import Patch, Region, RegionSpec, build_region, mass_properties
from .hand import Axis, Hand, HandRegion, Link
from .joint_file import ActuatorSpec, JointSpec, build_joint
from .pad_file import PressingSpec
from .shape_file import ShapeSpec, build_shape

__all__ = ["HandFile", "HandRegionSpec", "build_hand", "check_axes", "check_limits"]


class LinkSpec(FileModel):
    """A link: mass in kg and shapes."""

    name: Name
    mass: Mass
    shapes: Annotated[list[ShapeSpec], Field(min_length=1, max_length=100)]


class HandRegionSpec(RegionSpec):
    """A named region on a link."""

    link: Name


class HandFile(PressingSpec):
    """A hand file."""

    name: Name | None = None
    description: Text = ""
    sources: dict[str, Text] = {}
    mirror: bool = False
    palm: Name = "palm"
    links: Annotated[list[LinkSpec], Field(min_length=1, max_length=200)]
    joints: Annotated[list[JointSpec], Field(max_length=200)] = []
    actuators: dict[Name, ActuatorSpec] = {}
    regions: Annotated[dict[RegionName, HandRegionSpec], Field(max_length=1000)] = {}


def build_hand(spec: HandFile, source: str) -> Hand:
    """Builds a hand from its validated file.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    specs = _links_by_name(spec, source)
    regions = _build_regions(spec, specs, source)
    index: dict[str, int] = {}
    links: list[Link] = []
    for joint in _parents_first(spec, specs, source):
        name = joint.child if joint else spec.palm
        index[name] = len(links)
        parent = index[joint.parent] if joint else -1
        links.append(_build_link(specs[name], parent, joint, spec, regions, source))
    check_axes(links, source)
    placed = {
        name: HandRegion(name, index[spec.regions[name].link], region) for name, region in regions.items()
    }
    name = spec.name or plain_name(Path(source).stem, "hand")
    hand = Hand(name, tuple(links), placed, spec.description, dict(spec.sources), **spec.pressing())
    check_limits(hand, source)
    return hand


def check_limits(hand: Hand, source: str) -> None:
    """Refuses a hand whose coupled joints leave an independent one no room.

    Raises:
        InputError: naming the independent joint.
    """
    for name, (lower, upper) in zip(hand.independent_names, hand.limits, strict=True):
        if lower > upper:
            raise InputError(
                source,
                "joints",
                f"the limits of {name!r} and of the joints coupled to it exclude each other: "
                "give one of them other limits, or couple them in another way",
            )


def _links_by_name(spec: HandFile, source: str) -> dict[str, LinkSpec]:
    links: dict[str, LinkSpec] = {}
    for i, link in enumerate(spec.links):
        if link.name in links:
            raise InputError(source, f"links.{i}.name", f"there is already a link {link.name!r}")
        if link.name == "world":  # MuJoCo's name for the fixed frame
            raise InputError(source, f"links.{i}.name", "'world' is reserved: use another name")
        links[link.name] = link
    if spec.palm not in links:
        raise UnknownName(source, "palm", "link", spec.palm, links)
    return links


def _build_regions(spec: HandFile, links: dict[str, LinkSpec], source: str) -> dict[str, Region]:
    for name, region in spec.regions.items():
        if region.link not in links:
            raise UnknownName(source, f"regions.{name}.link", "link", region.link, links)
    return {name: build_region(region, source, f"regions.{name}") for name, region in spec.regions.items()}


def _parents_first(spec: HandFile, links: dict[str, LinkSpec], source: str) -> list[JointSpec | None]:
    """Joints depth first, so that a finger's stand together in a joint vector; None stands for the palm."""
    children: dict[str, list[JointSpec]] = {name: [] for name in links}
    carried = {spec.palm}
    for i, joint in enumerate(spec.joints):
        for field in ("parent", "child"):
            name = getattr(joint, field)
            if name not in links:
                raise UnknownName(source, f"joints.{i}.{field}", "link", name, links)
        if joint.child in carried:
            raise InputError(
                source, f"joints.{i}.child", f"{joint.child!r} already hangs on a joint (or is the palm)"
            )
        carried.add(joint.child)
        children[joint.parent].append(joint)
    order: list[JointSpec | None] = [None]
    pending = children[spec.palm][::-1]
    while pending:
        joint = pending.pop()
        order.append(joint)
        pending += children[joint.child][::-1]
    if len(order) != len(links):
        reached = {spec.palm} | {joint.child for joint in order if joint}
        loose = next(name for name in links if name not in reached)
        raise InputError(source, "joints", f"link {loose!r} is not connected to the palm")
    return order


def _build_link(
    spec: LinkSpec,
    parent: int,
    joint: JointSpec | None,
    hand: HandFile,
    regions: dict[str, Region],
    source: str,
) -> Link:
    patches = {
        name: region.patch
        for name, region in regions.items()
        if isinstance(region, Patch) and hand.regions[name].link == spec.name
    }
    shapes = tuple(
        build_shape(shape, patches, source, f"links.{spec.name}.shapes.{i}")
        for i, shape in enumerate(spec.shapes)
    )
    T, axes = np.eye(4), tuple[Axis, ...]()
    if joint is not None:
        T, axes = build_joint(joint, hand.actuators, source, f"joints.{joint.child}")
    return Link(spec.name, parent, T, axes, shapes, mass_properties(shapes, spec.mass))


def check_axes(links: list[Link], source: str) -> None:
    """Refuses links unless their axes have names of their own, and couplings lead to an independent one.

    Raises:
        InputError: naming the joint at fault.
    """
    by_name: dict[str, Axis] = {}
    for link in links:
        for axis in link.axes:
            if axis.name in by_name:
                raise InputError(
                    source, f"joints.{link.name}.axes", f"there is already a joint {axis.name!r}"
                )
            by_name[axis.name] = axis
    if not by_name:
        raise InputError(source, "joints", "a hand needs at least one joint that moves")
    for axis in by_name.values():
        field = f"joints.{axis.name}.coupled.to"
        seen = {axis.name}
        while axis.coupling is not None:
            master = axis.coupling.master
            if master not in by_name:
                raise UnknownName(source, field, "joint", master, by_name)
            if master in seen:
                raise InputError(source, field, "the couplings run in a circle")
            if by_name[master].kind != axis.kind:
                raise InputError(
                    source, field, f"{master!r} is {by_name[master].kind}, and {axis.name!r} is not"
                )
            seen.add(master)
            axis = by_name[master]
