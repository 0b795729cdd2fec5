"""Hollow walls, such as rims, that the flat pads of two jaws can pinch."""

from collections.abc import Sequence

from ...hands import Hand, HandRegion
from ...objects import ObjectModel
from .pad_edges import is_edge, is_pad, pad_edges
from .prospects import Choice, Prospects
from .screen import Combination, rate
from .surface import Site
from .tried import Tried
from .walls import wall_sites

__all__ = ["WALL_CONTACTS", "WallProspects", "has_pad_edges"]

WALL_CONTACTS = 3
"""Two edges of one pad inside, and the other pad outside."""

_WALLS = 16
_FINGERS = 2


def has_pad_edges(hand: Hand) -> bool:
    """Whether a hand has two fingers, with flat pads that can stand on their edges."""
    links = {region.link for region in _pads(hand)}
    return len(links) == _FINGERS and bool(pad_edges(hand))


class WallProspects(Prospects):
    """Hollow walls, with both edges of a pad inside and the other pad outside.

    What a wall carries depends on how pads reach over it, so weak ones are worth a try.

    Args:
        hand: of which `has_pad_edges` is true.
        obj: the object.
    """

    weak_are_worth_a_try = True

    def __init__(self, hand: Hand, obj: ObjectModel):
        self._edges, self._pads = pad_edges(hand), _pads(hand)
        regions = [edge for pair in self._edges for edge in pair.edges] + self._pads
        super().__init__(hand, obj, WALL_CONTACTS, regions, regions)
        self._sites: list[Site] = []

    @property
    def most_contacts(self) -> int:
        """No more: a pad has two edges."""
        return WALL_CONTACTS

    def look(self, k: int, seed: int, tried: Tried) -> None:
        """Walls that are looked at anew in each round, for the widths of the pads."""
        opening_m = max(
            self.widths.widest_m((a, b)) for a in self._pads for b in self._pads if a.link != b.link
        )
        self._sites = []
        for span_m in sorted({round(pair.span_m, 3) for pair in self._edges}):
            for triple in wall_sites(self.obj, span_m, opening_m, _WALLS, seed):
                self._sites += triple
        tried.sites += len(self._sites)

    def choices(self, k: int, seed: int) -> list[Choice]:
        """The edges of each pad, both ways round, with each pad on another finger."""
        return [
            (*edges, pad)
            for pair in self._edges
            for edges in (pair.edges, pair.edges[::-1])
            for pad in self._pads
            if pad.link != pair.link
        ]

    def combinations(self, choices: Sequence[Choice], seed: int, tried: Tried) -> list[Combination]:
        """Walls with force closure; which pads have a span that fits is left to the postures."""
        triples = [tuple(range(i, i + WALL_CONTACTS)) for i in range(0, len(self._sites), WALL_CONTACTS)]
        return rate(self.hand, self.obj, self._sites, triples)


def _pads(hand: Hand) -> list[HandRegion]:
    regions = hand.regions.values()
    return [region for region in regions if is_pad(region) and not is_edge(region)]
