"""What a task is: a hand, an object, the pairs of regions that must touch, and a test in physics."""

import reprlib
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..arguments import check_number
from ..base.numeric.arrays import Array
from ..errors import InputError, UnknownName
from ..geometry import PointRegion
from ..hands import Hand, load_hand
from .contact import Contact, Contacts, as_contacts
from .object_library import ObjectSource, load_object
from .object_model import ObjectModel, Part
from .physical_test import LiftTest, PhysicalTest, PressTest
from .region_check import check_regions
from .task_arguments import checked_name, checked_pose, checked_support, checked_test

__all__ = ["Task", "narrowed_limits"]

# Typed decimals of a limit such as 15 deg may pass it by a rounding.
_LIMIT_ROUNDING = 1e-6


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Task:
    """A configuration problem.

    Args:
        hand: the hand, the name of a built-in one, or the path of a hand file.
        object: the object, the name of a built-in one or of a member of a family, the path of an object file
            or a mesh, a trimesh, or vertices (n, 3) in m with faces (m, 3).
        contacts: pairs of a region of the hand and one of the object, see `Contacts`; each must lie on the
            surface of its body and face outwards, or be marked as `off_surface`.
        align_within_deg: by how much normals at contacts may fail to be opposed, where the contact itself
            doesn't say; see `Contact.align_within_deg`.
        name: the task's name; made of the object's and the hand's unless given.
        limits: [lower, upper] by joint where they are narrower than the hand's own, in rad or m; or an array
            (n_independent, 2), which may also be wider, to see what a hand with more room would do.
        description: a line for people.
        test: what the hand must do with the object in physics; to lift it unless given.
        support: a plane on which the object stands while it is grasped.
        T_palm_object: (4, 4) pose at which the object is held fixed.
        max_normal_force_N: largest normal force that a plan may ask of any contact; the hand's own limit
            holds as well.
        source: what asked for it, for error messages.

    Attributes:
        name: the task's name.
        hand: the hand.
        object: the object.
        contacts: the pairs that must touch, at least one.
        limits: (n_independent, 2) limits of the hand's independent joints, in rad or m.
        description: a line for people.
        test: what the hand must do with the object in physics.
        support: a plane on which the object stands while it is grasped, by a point and its normal upwards in
            the object's frame; the hand keeps above it. None where there is none.
        T_palm_object: (4, 4) pose at which the object is held fixed; None where it is free.
        max_normal_force_N: largest normal force that a plan may ask of any contact, the smaller of the task's
            own and the hand's; None where neither says.

    Raises:
        InputError: names the argument and what is allowed.
    """

    name: str
    hand: Hand
    object: ObjectModel
    contacts: tuple[Contact, ...]
    limits: Array
    description: str
    test: PhysicalTest
    support: PointRegion | None
    T_palm_object: Array | None
    max_normal_force_N: float | None

    def __init__(
        self,
        *,
        hand: Hand | str | Path,
        object: ObjectModel | ObjectSource,
        contacts: Contacts,
        name: str = "",
        limits: Array | Mapping[str, tuple[float, float]] | None = None,
        description: str = "",
        test: PhysicalTest | None = None,
        support: PointRegion | None = None,
        T_palm_object: Array | None = None,
        align_within_deg: float | None = None,
        max_normal_force_N: float | None = None,
        source: str = "Task",
    ):
        hand = hand if isinstance(hand, Hand) else load_hand(hand, source=source, field="hand")
        obj = (
            object if isinstance(object, ObjectModel) else load_object(object, source=source, field="object")
        )
        if max_normal_force_N is not None:
            check_number(f"{source}.max_normal_force_N", max_normal_force_N, above=0.0)
        fixed = None if T_palm_object is None else checked_pose(T_palm_object, source, "T_palm_object")
        limits_N = [f for f in (max_normal_force_N, hand.max_normal_force_N) if f is not None]
        pairs = as_contacts(contacts, hand, obj, align_within_deg=align_within_deg, source=source)
        check_regions(pairs, hand, obj, source)
        self.__dict__.update(
            name=checked_name(name, source) if name else f"{obj.name}_{hand.name}",
            hand=hand,
            object=obj,
            contacts=pairs,
            limits=_as_limits(limits, hand, source),
            description=description,
            test=LiftTest() if test is None else checked_test(test, obj, len(pairs), source),
            support=None if support is None else checked_support(support, source),
            T_palm_object=fixed,
            max_normal_force_N=min(limits_N, default=None),
        )

    def __repr__(self) -> str:
        contacts = ", ".join(f"{c.hand.name} - {c.object.name}" for c in self.contacts)
        return f"<Task {self.name}: hand {self.hand.name}, object {self.object.name}, contacts {contacts}>"

    @property
    def has_room(self) -> bool:
        """Whether normals at some contact may fail to be exactly opposed."""
        return any(contact.align_within_rad > 0.0 for contact in self.contacts)

    def aligned_exactly(self, *, unless_asked: bool = False) -> "Task":
        """The task with exactly opposed normals; itself where they are anyway.

        Args:
            unless_asked: whether contacts that name a room of their own keep it.
        """
        if not self.has_room:
            return self
        contacts = tuple(
            c if unless_asked and c.align_within_deg is not None else replace(c, align_within_deg=0.0)
            for c in self.contacts
        )
        exact = copy(self)
        exact.__dict__.update(contacts=contacts)  # regions are those that were checked
        return exact

    @property
    def carried(self) -> tuple[Part, ...]:
        """The parts of the object that the hand moves in the test; none where it only presses."""
        if isinstance(self.test, PressTest):
            return ()
        names = self.test.parts
        return tuple(part for part in self.object.parts if not names or part.name in names)

    @property
    def obstacles(self) -> tuple[Part, ...]:
        """The parts of the object that stay where they are while the hand moves the others."""
        carried = {part.name for part in self.carried}
        return tuple(part for part in self.object.parts if part.name not in carried)


def _as_limits(limits: Array | Mapping[str, tuple[float, float]] | None, hand: Hand, source: str) -> Array:
    if limits is None:
        return hand.limits.copy()
    if isinstance(limits, Mapping):
        return narrowed_limits(limits, hand, source, "limits")
    try:
        given = np.array(limits, dtype=float)
    except (TypeError, ValueError):
        given = np.empty(0)
    if given.shape != hand.limits.shape:
        allowed = f"must be [lower, upper] by joint, or an array {hand.limits.shape}"
        raise InputError(source, "limits", f"{allowed}, not {reprlib.repr(limits)}")
    if not np.isfinite(given).all() or np.any(given[:, 0] > given[:, 1]):
        raise InputError(source, "limits", "must be finite, no lower limit above the upper one")
    return given


def narrowed_limits(limits: Mapping[str, tuple[float, float]], hand: Hand, source: str, field: str) -> Array:
    """Limits (n_independent, 2) of a hand with some joints narrowed, in rad or m.

    Raises:
        InputError: no such joint, a lower limit above the upper one, or one outside the hand's own.
    """
    found = hand.limits.copy()
    for name, pair in limits.items():
        where = f"{field}.{name}"
        if name not in hand.independent_names:
            kind = f"independent joint of hand {hand.name}"
            raise UnknownName(source, where, kind, str(name), hand.independent_names)
        i = hand.independent_names.index(name)
        lower, upper = _interval(pair, source, where)
        if not lower <= upper:
            raise InputError(source, where, f"the lower limit {lower:g} is above the upper limit {upper:g}")
        if not (lower >= found[i, 0] - _LIMIT_ROUNDING and upper <= found[i, 1] + _LIMIT_ROUNDING):
            own = f"[{found[i, 0]:.6g}, {found[i, 1]:.6g}]"
            raise InputError(source, where, f"must lie inside the hand's own limits {own} (rad or m)")
        found[i] = max(lower, found[i, 0]), min(upper, found[i, 1])
    return found


def _interval(pair: object, source: str, field: str) -> tuple[float, float]:
    try:
        lower, upper = np.array(pair, dtype=float).tolist()
    except (TypeError, ValueError):
        lower = upper = np.nan
    if not isinstance(lower, float) or not np.isfinite([lower, upper]).all():
        allowed = "must be two finite numbers, the lower and the upper limit (rad or m)"
        raise InputError(source, field, f"{allowed}, not {reprlib.repr(pair)}")
    return lower, upper
