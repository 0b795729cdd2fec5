"""Task files (YAML): their fields, and how a task is built from them."""

from pathlib import Path
from typing import Annotated

from pydantic import Field

from ..base.files.fields import (
    Finite,
    Inline,
    Name,
    Named,
    NamedOrInline,
    Positive,
    Text,
    Vector3,
    plain_name,
)
from ..base.files.file_model import FileModel, parse
from ..base.files.file_paths import resolve_beside
from ..base.files.yaml_file import read_yaml
from ..errors import InputError, UnknownName
from ..geometry import PointRegion, RegionSpec, build_region
from ..hands import HAND_SUFFIXES, Hand, HandRegion, load_hand
from .contact import Contact, ObjectRegion, check_alignment, hand_region, object_region
from .object_library import load_object
from .object_model import ObjectModel
from .physical_test import LiftTest
from .physical_test_file import PhysicalTestSpec, build_test
from .pose_file import PoseSpec, build_pose
from .task import Task, narrowed_limits

__all__ = ["read_task"]


class HandRegionSpec(RegionSpec):
    """A region given inside a task, on a link of the hand."""

    link: Name


class ContactSpec(FileModel):
    """One contact: each side the name of a region, or a region in place."""

    hand: Annotated[Named | Annotated[HandRegionSpec, Inline], NamedOrInline]
    object: Annotated[Named | Annotated[RegionSpec, Inline], NamedOrInline]
    align_within_deg: Finite | None = None


class SupportSpec(FileModel):
    """The plane on which the object stands, in the frame of the object."""

    point: Vector3
    normal: Vector3


class TaskFile(FileModel):
    """A task file."""

    name: Name | None = None
    description: Text = ""
    hand: str
    object: str
    contacts: Annotated[list[ContactSpec], Field(min_length=1, max_length=64)]
    align_within_deg: Finite | None = None
    joint_limits: Annotated[dict[str, tuple[Finite, Finite]], Field(max_length=1000)] = {}
    test: PhysicalTestSpec | None = None
    support: SupportSpec | None = None
    object_pose: PoseSpec | None = None
    max_normal_force: Positive | None = None


def read_task(path: Path, *, hand: Hand | None = None) -> Task:
    """Reads a task file with the object that it names, and the hand unless another is given in its place.

    Raises:
        InputError: naming the file, the field and what is allowed.
    """
    spec = parse(TaskFile, read_yaml(path), path)
    source = str(path)
    hand = hand or load_hand(_beside(path, spec.hand, "hand"), source=source, field="hand")
    obj = load_object(_beside(path, spec.object, "object"), source=source, field="object")
    _check_repetitions(spec, source)
    contacts = tuple(
        _build_contact(c, hand, obj, source, f"contacts.{i}") for i, c in enumerate(spec.contacts)
    )
    limits = narrowed_limits(spec.joint_limits, hand, source, "joint_limits")
    test = LiftTest() if spec.test is None else build_test(spec.test, obj, len(contacts), source)
    support = None if spec.support is None else _build_support(spec.support, source)
    fixed = None if spec.object_pose is None else build_pose(spec.object_pose, source, "object_pose")
    return Task(
        name=spec.name or plain_name(path.stem, "task"),
        hand=hand,
        object=obj,
        contacts=contacts,
        limits=limits,
        description=spec.description,
        test=test,
        support=support,
        T_palm_object=fixed,
        align_within_deg=spec.align_within_deg,
        max_normal_force_N=spec.max_normal_force,
        source=source,
    )


def _build_support(spec: SupportSpec, source: str) -> PointRegion:
    plane = build_region(RegionSpec(point=spec.point, normal=spec.normal), source, "support")
    assert isinstance(plane, PointRegion)
    return plane


def _beside(path: Path, name: str, field: str) -> str | Path:
    return resolve_beside(path, name, field) if name.lower().endswith(HAND_SUFFIXES) else name


def _check_repetitions(spec: TaskFile, source: str) -> None:
    """A region may touch several others, but the same pair twice is a slip of the pen."""
    seen: dict[tuple[str, str], int] = {}
    for i, contact in enumerate(spec.contacts):
        if isinstance(contact.hand, str) and isinstance(contact.object, str):
            first = seen.setdefault((contact.hand, contact.object), i)
            if first != i:
                raise InputError(source, f"contacts.{i}", f"the same pair of regions as contacts.{first}")


def _build_contact(spec: ContactSpec, hand: Hand, obj: ObjectModel, source: str, field: str) -> Contact:
    if isinstance(spec.hand, str):
        on_hand = hand_region(spec.hand, hand, source, f"{field}.hand")
    else:
        names = [link.name for link in hand.links]
        if spec.hand.link not in names:
            raise UnknownName(
                source, f"{field}.hand.link", f"link of hand {hand.name}", spec.hand.link, names
            )
        region = build_region(spec.hand, source, f"{field}.hand")
        on_hand = HandRegion(f"{spec.hand.link}/inline", hand.link_index(spec.hand.link), region)
    room = check_alignment(spec.align_within_deg, source, f"{field}.align_within_deg")
    if isinstance(spec.object, str):
        return Contact(on_hand, object_region(spec.object, obj, source, f"{field}.object"), room)
    region = build_region(spec.object, source, f"{field}.object")
    return Contact(on_hand, ObjectRegion("inline", region), room)
