"""How a contact region lies on the shapes of its link."""

from ..geometry import ConvexSurface, Placement, place_region
from .hand import Hand, HandRegion

__all__ = ["hand_placement"]


def hand_placement(hand: Hand, region: HandRegion) -> Placement:
    """How far a region of a hand lies off the shapes of its link, and how it faces there.

    The shapes are what collides: spheres, capsules, boxes and hulls, and of their overlaps what is outside.
    """
    return place_region(region.region, ConvexSurface(hand.links[region.link].shapes))
