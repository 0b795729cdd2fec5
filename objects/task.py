"""What a task is: a hand, an object, and the pairs of regions that must touch."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry import Region
from ..hands import Hand, HandRegion
from .object_model import ObjectModel

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


@dataclass(frozen=True, eq=False)
class Task:
    """A configuration problem.

    Attributes:
        name: the task's name.
        hand: the hand.
        object: the object.
        contacts: the pairs that must touch, at least one.
        limits: (n_independent, 2) limits of the hand's independent joints, inside the hand's own.
        description: a line for people.
    """

    name: str
    hand: Hand
    object: ObjectModel
    contacts: tuple[Contact, ...]
    limits: NDArray[np.float64]
    description: str = ""
