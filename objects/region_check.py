"""How contact regions lie on an object, and the refusal of contacts whose regions are off the surface."""

from collections.abc import Sequence

from ..errors import InputError
from ..geometry import Placement, Region, place_region
from ..geometry.solids import MeshSurface
from ..hands import Hand, hand_placement
from .contact import Contact
from .object_model import ObjectModel

__all__ = ["check_regions", "object_placement"]


def object_placement(obj: ObjectModel, region: Region) -> Placement:
    """How far a region of an object lies off its surface, and how it faces there."""
    return place_region(region, MeshSurface(obj.mesh))


def check_regions(contacts: Sequence[Contact], hand: Hand, obj: ObjectModel, source: str) -> None:
    """Refuses contacts whose regions lie off the surface of their body, or face inwards.

    Raises:
        InputError: naming the region, what is wrong with it, and what to do.
    """
    surface = MeshSurface(obj.mesh)
    for i, contact in enumerate(contacts):
        region, link = contact.hand, hand.links[contact.hand.link].name
        if fault := hand_placement(hand, region).fault(region.region, f"link {link}"):
            raise InputError(source, f"contacts.{i}.hand", f"region {region.name!r} {fault}")
        side = contact.object
        if fault := place_region(side.region, surface).fault(side.region, obj.name):
            raise InputError(source, f"contacts.{i}.object", f"region {side.name!r} {fault}")
