"""What the contacts of a task can carry, whatever the hand does: known before any kinematics."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from math import inf

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import combined_mass, even_directions
from ...hands import Hand
from ..contact import Contact
from ..object_model import ObjectModel, Part
from ..physical_test import LiftTest
from ..task import Task
from .forces import growing_forces
from .multiple import best_points, most_multiple
from .places import Places, contact_places

__all__ = ["WANTED", "Carrying", "Limit", "Load", "carrying", "object_load", "task_load"]

WANTED = 1.5
"""Multiple of the weight that a squeeze is planned for: gravity sets in at once, and an object swings."""

_FEW_POINTS = 8
# So many directions say first that little is carried; the others are a whole sphere of them.
_FIRST_DIRECTIONS = 4
# Friction that is looked at where that of the object does not do, and how finely.
_LEAST_FRICTION, _MOST_FRICTION, _HALVINGS = 0.05, 2.0, 6
# Forces of fingers within this factor of each other are said as one.
_ALIKE = 1.2
# Of the weight, so little is none of it.
_NOTHING = 1e-3


class Limit(Enum):
    """What keeps contacts from carrying more: what has to change by the smaller factor."""

    FORCE = "finger force"
    FRICTION = "friction"
    PLACES = "the places"


_WHY = {
    Limit.FORCE: "fingers are too weak",
    Limit.FRICTION: "there is too little friction",
    Limit.PLACES: "their places don't face each other",
}


@dataclass(frozen=True, eq=False)
class Load:
    """What is to be carried.

    Attributes:
        weight_N: of what the hand carries.
        centre: (3,) its centre of mass in the object's frame in m.
        friction: between hand and object.
        gravity: (n, 3) unit vectors in the palm frame, each direction by itself.
        R_object_palm: (3, 3) where the object is held fixed; None where it may be turned.
    """

    weight_N: float
    centre: Array
    friction: float
    gravity: Array
    R_object_palm: Array | None = None

    def multiple(
        self, places: Sequence[Places], *, directions: Array | None = None, least: float = 0.0
    ) -> float:
        """The multiple of the weight that contacts carry, each spread over its places.

        Args:
            places: of the contacts.
            directions: (m, 3) of forces that are looked at; the fewer, the larger and rougher the multiple.
            least: where the first few directions show that it is no more than this, that will do.
        """
        few = directions is None and sum(len(place.points) for place in places) <= _FEW_POINTS
        directions = even_directions(1) if directions is None else directions
        counts = (_FIRST_DIRECTIONS, len(directions)) if least > 0.0 else (len(directions),)
        multiple = inf
        # Edges around the cones, so that nothing is missed.
        for forces in growing_forces(
            places, self.centre, self.friction, directions, counts, subdivisions=2 if few else 1, outside=True
        ):
            multiple = most_multiple(forces, self.weight_N, self.gravity, self.R_object_palm, refined=True)
            if multiple <= least:
                break
        return multiple

    def best(self, places: Sequence[Places], enough: float = inf, *, polished: bool = True) -> list[Places]:
        """One point of each contact with which they carry much, at least `enough` where that is found.

        Unless `polished`, points of a grid alone are looked at: what many grasps come near, not the most.
        """
        return best_points(
            places,
            self.centre,
            self.friction,
            self.gravity,
            R_object_palm=self.R_object_palm,
            enough_N=enough * self.weight_N,
            polished=polished,
        )


@dataclass(frozen=True)
class Carrying:
    """What contacts can carry: found by a search, not proved.

    Attributes:
        multiple: of the weight, in every direction of the test, the object turned for the best, each contact
            at one point: of the points looked at the best, or the first that carry `WANTED`.
        spread: the same, perhaps infinite, where each contact's force may be spread over its region, in each
            direction in another way; no grasp whose contacts stay in their regions carries more, but for the
            grid and the edges of the cones.
        limit: what keeps them from more; None where they carry `WANTED`.
        forces_N: largest normal force of each contact; infinite where fingers press against it.
        friction: between hand and object.
        force_factor: factor on all forces with which they would carry `WANTED`; None where no force would.
        friction_needed: friction with which they would; None where none up to 2 would.
    """

    multiple: float
    spread: float
    limit: Limit | None
    forces_N: tuple[float, ...]
    friction: float
    force_factor: float | None = None
    friction_needed: float | None = None

    @property
    def is_enough(self) -> bool:
        """Whether they carry what a squeeze is planned for."""
        return self.limit is None

    def __str__(self) -> str:
        """A line for people."""
        if self.limit is None:
            return f"these contacts can carry {WANTED:g} times the weight (computed)"
        return (
            f"these contacts carry {_at_most(self.multiple)}, whatever the hand does (computed at single "
            f"points, not proved; a squeeze wants {WANTED:g} times): {_WHY[self.limit]}{self._change()}"
        )

    def _change(self) -> str:
        """In brackets, what would do, the smaller change first."""
        changes = []
        if self.friction_needed is not None:
            changes.append(f"friction {self.friction_needed:.2f} in place of {self.friction:.2g}")
        if self.force_factor is not None and (force := self._force(self.force_factor)):
            changes.insert(0 if self.limit is Limit.FORCE else 1, force)
        if self.limit is Limit.PLACES:
            return f"; no friction up to {_MOST_FRICTION:g} would do"
        return f" ({', or '.join(changes)} would do)" if changes else ""

    def _force(self, factor: float) -> str:
        """The forces that would do; empty where none is limited."""
        finite = [force for force in self.forces_N if np.isfinite(force)]
        if not finite:
            return ""
        if max(finite) > _ALIKE * min(finite):
            return f"{factor:.2g} times the force of each finger"
        return f"{factor * max(finite):.0f} N a finger in place of {max(finite):.0f}"


def carrying(contacts: Sequence[Contact], hand: Hand, load: Load, most_N: float | None = None) -> Carrying:
    """What contacts can carry.

    Args:
        contacts: pairs of regions.
        hand: the hand, whose fingers limit the forces.
        load: what is to be carried.
        most_N: largest normal force that the task allows at any contact.
    """
    places = contact_places(contacts, hand, most_N)
    points = load.best(places, WANTED)
    found = Carrying(
        multiple=load.multiple(points),
        spread=load.multiple(places),
        limit=None,
        forces_N=tuple(place.largest_N for place in places),
        friction=load.friction,
    )
    if found.multiple >= WANTED:
        return found
    factor = WANTED / found.multiple if found.multiple > _NOTHING else None
    friction = _friction_needed(points if factor is not None else _with_more_friction(places, load), load)
    if factor is None and friction is None:
        limit = Limit.PLACES
    elif factor is None or (friction is not None and friction / load.friction < factor):
        limit = Limit.FRICTION
    else:
        limit = Limit.FORCE
    return replace(found, limit=limit, force_factor=factor, friction_needed=friction)


def task_load(
    task: Task,
    *,
    friction: float | None = None,
    gravity: float = 9.81,
    directions: Sequence[tuple[float, float, float]] | None = None,
    mass_kg: float | None = None,
) -> Load | None:
    """The load of a task; None where its test is no lift, as a stand then carries the object.

    Args:
        task: the task.
        friction: None takes the object's.
        gravity: in m/s^2.
        directions: of gravity in the palm frame; None takes those of the task.
        mass_kg: of the object; None takes its own.
    """
    if not isinstance(task.test, LiftTest):
        return None
    load = object_load(task.object, task.carried, task.test.directions if directions is None else directions)
    weight = load.weight_N if mass_kg is None else load.weight_N * mass_kg / task.object.inertia.mass
    fixed = None if task.T_palm_object is None else task.T_palm_object[:3, :3].T
    return replace(
        load,
        weight_N=weight * gravity / 9.81,
        friction=load.friction if friction is None else friction,
        R_object_palm=fixed,
    )


def object_load(
    obj: ObjectModel,
    parts: Sequence[Part] | None = None,
    directions: Sequence[tuple[float, float, float]] = LiftTest().directions,
) -> Load:
    """The load of an object, or of some of its parts, in directions of gravity in the palm frame."""
    inertia = obj.inertia if parts is None else combined_mass(part.inertia for part in parts)
    return Load(inertia.mass * 9.81, inertia.centre, obj.friction, np.array(directions))


def _friction_needed(points: Sequence[Places], load: Load) -> float | None:
    """The least friction up to 2 with which points carry enough, to a 64th of the way there."""
    if replace(load, friction=_MOST_FRICTION).multiple(points) < WANTED:
        return None
    low, high = load.friction, _MOST_FRICTION
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if replace(load, friction=middle).multiple(points) < WANTED:
            low = middle
        else:
            high = middle
    return high


def _with_more_friction(places: Sequence[Places], load: Load) -> list[Places]:
    """Points that carry enough with more friction, the less of it the better; where none carry any load yet.

    There a search with the friction as it is has nothing to go by.
    """
    friction = max(load.friction, _LEAST_FRICTION)
    while True:
        friction = min(2.0 * friction, _MOST_FRICTION)
        rougher = replace(load, friction=friction)
        points = rougher.best(places, WANTED, polished=False)
        if friction == _MOST_FRICTION or rougher.multiple(points) >= WANTED:
            return points


def _at_most(multiple: float) -> str:
    if multiple < _NOTHING:
        return "none of the weight"
    return f"at most {multiple:.2f} {'of' if multiple < 1.0 else 'times'} the weight"
