"""What a family makes from a seed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...geometry import Region
from ..object_model import Part

__all__ = ["Family", "Member"]


@dataclass(frozen=True, eq=False)
class Member:
    """The shape, the regions and the grasps of one member of a family.

    Attributes:
        parts: its parts with their mass.
        regions: named contact regions on its surface.
        contacts: pairs (region of the SA hand, region of the object) that make the usual grasp.
        sources: where its figures come from.
        stronger: other grasps, as pairs, for a member that is too heavy for the usual one; the first that
            carries it is taken.
    """

    parts: tuple[Part, ...]
    regions: Mapping[str, Region]
    contacts: tuple[tuple[str, str], ...]
    sources: dict[str, str] = field(default_factory=dict)
    stronger: tuple[tuple[tuple[str, str], ...], ...] = ()


@dataclass(frozen=True)
class Family:
    """A family of objects.

    Attributes:
        description: a line for people.
        make: makes a member from random numbers.
    """

    description: str
    make: Callable[[np.random.Generator], Member]
