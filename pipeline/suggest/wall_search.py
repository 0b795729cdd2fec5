"""The search for hollow walls, such as rims, that the flat pads of two jaws can pinch."""

from ...hands import Hand, HandRegion
from ...objects import ObjectModel
from .pad_edges import PadEdges, is_edge, is_pad, pad_edges
from .screen import Combination, rate
from .search import Search
from .walls import wall_sites

__all__ = ["WALL_CONTACTS", "WallSearch", "has_pad_edges"]

WALL_CONTACTS = 3
"""Two edges of one pad inside, and the other pad outside."""

_WALLS = 16
_FINGERS = 2


def has_pad_edges(hand: Hand) -> bool:
    """Whether a hand has two fingers, with flat pads that can stand on their edges."""
    links = {region.link for region in _pads(hand)}
    return len(links) == _FINGERS and bool(pad_edges(hand))


class WallSearch(Search):
    """A search for tasks of three contacts: both edges of a pad inside a hollow wall, the other pad outside.

    Args:
        hand: of which `has_pad_edges` is true.
        obj: the object.
        seed: the same seed tries the same in the same order.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, seed: int = 0):
        self._edges: list[PadEdges] = pad_edges(hand)
        super().__init__(hand, obj, WALL_CONTACTS, seed)
        self.tried.most_contacts = WALL_CONTACTS

    def can_carry(self) -> bool:
        """Whether there is a wall to try: what it carries depends on how pads reach over it."""
        return super().can_carry() or self.tried.combinations > 0

    def _own_regions(self) -> tuple[list[HandRegion], list[HandRegion]]:
        regions = [edge for pair in self._edges for edge in pair.edges] + _pads(self._hand)
        return regions, regions

    def _look_for_sites(self, k: int, seed: int) -> None:
        """Walls that are looked at anew in each round, for the widths of the pads."""
        pads = _pads(self._hand)
        opening_m = max(self._widths.widest_m((a, b)) for a in pads for b in pads if a.link != b.link)
        self._sites = []
        for span_m in sorted({round(pair.span_m, 3) for pair in self._edges}):
            for triple in wall_sites(self._obj, span_m, opening_m, _WALLS, seed):
                self._sites += triple
        self.tried.sites += len(self._sites)

    def _choices(self, k: int, seed: int) -> list[tuple[HandRegion, ...]]:
        pads = _pads(self._hand)
        return [
            (*edges, pad)
            for pair in self._edges
            for edges in (pair.edges, pair.edges[::-1])
            for pad in pads
            if pad.link != pair.link
        ]

    def _screened(self, choices: list[tuple[HandRegion, ...]], seed: int) -> list[Combination]:
        """Walls with force closure; which pads have a span that fits is left to the postures."""
        triples = [tuple(range(i, i + WALL_CONTACTS)) for i in range(0, len(self._sites), WALL_CONTACTS)]
        return rate(self._hand, self._obj, self._sites, triples)


def _pads(hand: Hand) -> list[HandRegion]:
    regions = hand.regions.values()
    return [region for region in regions if is_pad(region) and not is_edge(region)]
