"""Contacts of a task, and how they are made from what people write in Python."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, UnknownName
from ..geometry import BezierPatch, Cap, Patch, PointRegion, Region, build_patch, check_regular, region_normal
from ..hands import Hand, HandRegion
from .object_model import ObjectModel

__all__ = [
    "Contact",
    "Contacts",
    "ObjectRegion",
    "as_contacts",
    "check_alignment",
    "hand_region",
    "object_region",
]

# Flat pads meet flat faces exactly only in a model without any rounding; by this much nobody can tell.
_FLAT_ROOM_DEG = 0.01
_LEAST_ROOM_DEG, _LARGEST_ROOM_DEG = 1e-6, 45.0


@dataclass(frozen=True, eq=False)
class ObjectRegion:
    """A contact region in the frame of the object."""

    name: str
    region: Region


@dataclass(frozen=True, eq=False)
class Contact:
    """A pair of regions that touch at some point with their normals opposed (paper, equations 15 and 16).

    Attributes:
        hand: region of the hand.
        object: region of the object.
        align_within_deg: by how much the normals may fail to be opposed, in degrees; 0 asks for exactly
            opposed ones. None for the usual: 0.01 where the hand's region is flat, for alignments of parallel
            flats are dependent equations that nothing can prove; else 0. A cap, whose normal is whatever the
            other side asks for, has no use for room, and gets none.
    """

    hand: HandRegion
    object: ObjectRegion
    align_within_deg: float | None = None

    @property
    def align_within_rad(self) -> float:
        """The angle by which the normals may fail to be opposed, in rad."""
        if isinstance(self.hand.region, Cap) or isinstance(self.object.region, Cap):
            return 0.0
        if self.align_within_deg is not None:
            return float(np.deg2rad(self.align_within_deg))
        is_flat = region_normal(self.hand.region) is not None
        return float(np.deg2rad(_FLAT_ROOM_DEG)) if is_flat else 0.0


def check_alignment(value: object, source: str, field: str) -> float | None:
    """An angle for `Contact.align_within_deg`.

    Raises:
        InputError: neither None nor 0 nor within the allowed range.
    """
    if value is None:
        return None
    allowed = (
        "must be 0 for exactly opposed normals, or an angle from "
        f"{_LEAST_ROOM_DEG:g} to {_LARGEST_ROOM_DEG:g} degrees"
    )
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise InputError(source, field, allowed)
    if value != 0.0 and not _LEAST_ROOM_DEG <= value <= _LARGEST_ROOM_DEG:  # NaN fails too
        raise InputError(source, field, f"{allowed}, not {value:g}")
    return float(value)


HandSide: TypeAlias = str | HandRegion
ObjectSide: TypeAlias = str | ObjectRegion | Region | BezierPatch | NDArray[np.floating[Any]]
Contacts: TypeAlias = Mapping[HandSide, ObjectSide] | Iterable[Contact | tuple[HandSide, ObjectSide]]
"""Pairs of a region of the hand and one of the object: by name, as values, or (the object only) as an array
(M+1, N+1, 3) of Bezier control points in m."""


def as_contacts(
    contacts: Contacts,
    hand: Hand,
    obj: ObjectModel,
    *,
    align_within_deg: float | None = None,
    source: str = "Task",
) -> tuple[Contact, ...]:
    """Contacts from pairs.

    Args:
        contacts: at least one pair; a mapping where each region of the hand touches once.
        hand: whose regions are meant by name.
        obj: likewise.
        align_within_deg: room for the normals of contacts that have none of their own, see `Contact`.
        source: what asked for them, for error messages.

    Raises:
        InputError: no pairs, an unknown name, or a region that can't be used.
    """
    pairs = _pairs(contacts, source)
    if not pairs:
        raise InputError(source, "contacts", "needs at least one pair of regions")
    room = check_alignment(align_within_deg, source, "align_within_deg")
    made = [_contact(pair, hand, obj, source, f"contacts.{i}") for i, pair in enumerate(pairs)]
    return tuple(
        contact
        if room is None or contact.align_within_deg is not None
        else replace(contact, align_within_deg=room)
        for contact in made
    )


def _pairs(contacts: object, source: str) -> list[object]:
    if isinstance(contacts, Mapping):
        return list(contacts.items())
    if isinstance(contacts, Iterable) and not isinstance(contacts, str | bytes):
        return list(contacts)
    raise InputError(source, "contacts", "must be pairs of regions, such as {'index/tip': 'front'}")


def _contact(pair: object, hand: Hand, obj: ObjectModel, source: str, field: str) -> Contact:
    if isinstance(pair, Contact):
        hand_region(pair.hand, hand, source, f"{field}.hand")
        check_alignment(pair.align_within_deg, source, f"{field}.align_within_deg")
        return pair
    if not isinstance(pair, tuple | list) or len(pair) != 2:
        raise InputError(source, field, "must be a pair: a region of the hand and one of the object")
    on_hand, on_object = pair
    return Contact(
        hand_region(on_hand, hand, source, f"{field}.hand"),
        object_region(on_object, obj, source, f"{field}.object"),
    )


def hand_region(side: object, hand: Hand, source: str, field: str) -> HandRegion:
    """A region of a hand, by name or as it is.

    Raises:
        InputError: an unknown name, a link that the hand lacks, or something else.
    """
    if isinstance(side, HandRegion):
        if not 0 <= side.link < len(hand.links):
            raise InputError(source, field, f"lies on link {side.link}, which hand {hand.name} lacks")
        return side
    if not isinstance(side, str):
        raise InputError(source, field, f"must be the name of a region of hand {hand.name}, or a HandRegion")
    if side not in hand.regions:
        raise UnknownName(source, field, f"region of hand {hand.name}", side, hand.regions)
    return hand.regions[side]


def object_region(side: object, obj: ObjectModel, source: str, field: str) -> ObjectRegion:
    """A region of an object, by name, as it is, or from control points.

    Raises:
        InputError: an unknown name, or what makes no region.
    """
    if isinstance(side, ObjectRegion):
        return side
    if isinstance(side, str):
        if side not in obj.regions:
            raise UnknownName(source, field, f"region of object {obj.name}", side, obj.regions)
        return ObjectRegion(side, obj.regions[side])
    return ObjectRegion("inline", as_region(side, source, field))


def as_region(value: object, source: str, field: str) -> Region:
    """A contact region from a region, a patch, or an array (M+1, N+1, 3) of control points.

    Raises:
        InputError: something else, or control points that are not finite or make no regular patch.
    """
    if isinstance(value, Cap | Patch | PointRegion):
        return value
    if isinstance(value, BezierPatch):
        return Patch(check_regular(value, source, field))
    try:
        points = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        points = np.zeros(0)
    if points.ndim != 3 or points.shape[2] != 3:
        raise InputError(
            source, field, "must be a region, or an array (M+1, N+1, 3) of Bezier control points in m"
        )
    if not np.isfinite(points).all():
        raise InputError(source, field, "has control points that are not finite")
    rows = [[(float(x), float(y), float(z)) for x, y, z in row] for row in points]
    return Patch(check_regular(build_patch(rows, source, field), source, field))
