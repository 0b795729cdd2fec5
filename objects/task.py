"""What a task is: a hand, an object, the pairs of regions that must touch, and a test in physics."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..geometry import PointRegion, Region
from ..hands import Hand, HandRegion
from .object_model import ObjectModel, Part
from .physical_test import LiftTest, PhysicalTest, PressTest

__all__ = ["Contact", "ObjectRegion", "Task"]


@dataclass(frozen=True, eq=False)
class ObjectRegion:
    """A contact region in the frame of the object."""

    name: str
    region: Region


@dataclass(frozen=True, eq=False)
class Contact:
    """A pair of regions that touch at some point with their normals opposed (paper, equations 15 and 16)."""

    hand: HandRegion
    object: ObjectRegion


@dataclass(frozen=True, eq=False, repr=False)
class Task:
    """A configuration problem.

    Attributes:
        name: the task's name.
        hand: the hand.
        object: the object.
        contacts: the pairs that must touch, at least one.
        limits: (n_independent, 2) limits of the hand's independent joints, inside the hand's own.
        description: a line for people.
        test: what the hand must do with the object in physics.
        support: a plane on which the object stands while it is grasped, by a point and its normal upwards in
            the object's frame; the hand keeps above it. None where there is none.
        T_palm_object: (4, 4) pose at which the object is held fixed; None where it is free.
    """

    name: str
    hand: Hand
    object: ObjectModel
    contacts: tuple[Contact, ...]
    limits: NDArray[np.float64]
    description: str = ""
    test: PhysicalTest = field(default_factory=LiftTest)
    support: PointRegion | None = None
    T_palm_object: NDArray[np.float64] | None = None

    def __repr__(self) -> str:
        contacts = ", ".join(f"{c.hand.name} - {c.object.name}" for c in self.contacts)
        return f"<Task {self.name}: hand {self.hand.name}, object {self.object.name}, contacts {contacts}>"

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
