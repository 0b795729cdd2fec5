"""What a round of a search looks at: places of the object, and fingers that may touch them together."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from ...hands import Hand, HandRegion
from ...objects import ObjectModel
from .fingers import finger_choices, finger_regions, most_contacts
from .growing import PINCH
from .screen import Combination, PairLimits, screen
from .surface import Site, edge_sites, named_sites, opposite_sites, surface_sites
from .tried import Tried
from .width import Widths

__all__ = ["Choice", "Prospects", "SurfaceProspects"]

# Places that each round adds, and combinations that it looks at.
_SURFACE, _EDGES, _COMBINATIONS = 96, 32, 40
_MOST_SITES = 480
# Places that others are looked for across from, where none go together.
_ACROSS = 48
# Room for flat pads of simple hands on what is not parallel as they are, and what counts as parallel.
_ROOM_DEG, _PARALLEL_RAD = 2.0, 1e-4

Choice = tuple[HandRegion, ...]
"""Regions of a hand that touch at once."""


class Prospects(ABC):
    """Places and fingers for tasks of one number of contacts.

    Args:
        hand: the hand.
        obj: the object.
        contacts: pairs of regions in a task.
        regions: of the hand that may touch.
        tips: of these, those that come first.

    Attributes:
        hand: the hand.
        obj: the object.
        contacts: pairs of regions in a task.
        regions: of the hand that may touch.
        tips: of these, those that come first.
        widths: what simple hands can take between two regions.
        weak_are_worth_a_try: whether what seems too weak for the weight may carry it all the same.
    """

    weak_are_worth_a_try = False

    def __init__(
        self,
        hand: Hand,
        obj: ObjectModel,
        contacts: int,
        regions: Sequence[HandRegion],
        tips: Sequence[HandRegion],
    ):
        self.hand, self.obj, self.contacts = hand, obj, contacts
        self.regions, self.tips = regions, tips
        self.widths = Widths(hand, regions)

    @property
    def most_contacts(self) -> int:
        """How many contacts a task of the kind can have with the hand."""
        return most_contacts(self.hand)

    @abstractmethod
    def look(self, k: int, seed: int, tried: Tried) -> None:
        """Finds the places of round k, and notes in `tried` how many."""

    @abstractmethod
    def choices(self, k: int, seed: int) -> list[Choice]:
        """Choices of fingers of round k."""

    @abstractmethod
    def combinations(self, choices: Sequence[Choice], seed: int, tried: Tried) -> list[Combination]:
        """Places with force closure for choices of fingers; why there are none is noted in `tried`."""

    def pinches(self, k: int, seed: int) -> list[tuple[Combination, Choice]]:
        """Two of the places that round k added, with two fingers each; none where there are no such."""
        return []

    def limits(self, choice: Choice) -> PairLimits:
        """What two regions can touch, with room at both contacts for normals that don't face each other."""
        room_rad = 2.0 * np.radians(_ROOM_DEG)
        return PairLimits(self.widths.widest_m(choice), self.widths.askew_rad(choice) + room_rad)

    def are_within_limits(self, combination: Combination, choice: Choice) -> bool:
        """Whether the hand opens so far, and turns so far, as the places ask for."""
        limits = self.limits(choice)
        return combination.width_m <= limits.widest_m and combination.askew_rad <= limits.askew_rad

    def room_deg(self, k: int, combination: Combination, choice: Choice) -> float | None:
        """Room for normals at flat pads: where jaws or places are not parallel, and later for all jaws."""
        if not self.widths.are_known:
            return None
        is_askew = combination.askew_rad > self.widths.askew_rad(choice) + _PARALLEL_RAD
        return _ROOM_DEG if k > 0 or is_askew or not self.widths.are_parallel(choice) else None


class SurfaceProspects(Prospects):
    """Places all over the surface, ever more of them, and the fingertips, later all regions.

    Args:
        hand: regions named `<finger>/tip` are its fingertips and come first.
        obj: the object.
        contacts: pairs of regions in a task.
        places: that are known beforehand.

    Raises:
        InputError: the hand has regions on fewer links than contacts are asked for.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, contacts: int, places: Sequence[Site] = ()):
        tips, regions = finger_regions(hand, contacts)
        super().__init__(hand, obj, contacts, regions, tips)
        self._sites = list(places)
        self._new_sites: list[Site] = []

    def look(self, k: int, seed: int, tried: Tried) -> None:
        """Adds the places of a round; later ones have places on edges as well, and let go of the oldest."""
        new = named_sites(self.obj) if k == 0 else edge_sites(self.obj, _EDGES, seed)
        on_surface, tried.covered = surface_sites(self.obj, _SURFACE, seed)
        self._new_sites = new + on_surface
        self._add(self._new_sites, tried)

    def choices(self, k: int, seed: int) -> list[Choice]:
        """Choices of fingertips; in every second round of all regions.

        Of simple hands all from the start: jaws have few, and their tips may be edges where pads are flat.
        """
        regions = self.tips if k % 2 == 0 and not self.widths.are_known else self.regions
        return finger_choices(regions, self.contacts, seed)

    def combinations(self, choices: Sequence[Choice], seed: int, tried: Tried) -> list[Combination]:
        """Sets of places for choices of fingers, with places across from others where there are none.

        Where there are none even then, what simple hands can't is noted.
        """
        limits = list(dict.fromkeys(map(self.limits, choices))) or [PairLimits()]
        if found := self._screened(limits, seed):
            return found
        self._add(opposite_sites(self.obj, self._sites[-_ACROSS:]), tried)
        if found := self._screened(limits, seed):
            return found
        self._note_what_is_in_the_way(max(limits), seed, tried)
        return []

    def pinches(self, k: int, seed: int) -> list[tuple[Combination, Choice]]:
        """Two of the places that round k added, with two fingers each; of simple hands none."""
        if self.contacts <= PINCH or self.widths.are_known:
            return []
        pairs = SurfaceProspects(self.hand, self.obj, PINCH, self._new_sites)
        choices = pairs.choices(k, seed)
        found = pairs.combinations(choices, seed, Tried(PINCH))
        return [(combination, choice) for combination in found for choice in choices]

    def _add(self, sites: list[Site], tried: Tried) -> None:
        tried.sites += len(sites)
        self._sites = (self._sites + sites)[-_MOST_SITES:]

    def _screened(self, limits: Sequence[PairLimits], seed: int) -> list[Combination]:
        return screen(self.hand, self.obj, self._sites, self.contacts, _COMBINATIONS, seed, limits=limits)

    def _note_what_is_in_the_way(self, widest: PairLimits, seed: int, tried: Tried) -> None:
        """By how much places miss that go together but for the hand's opening, or for how they face."""
        tried.apart_m = None
        if np.isfinite(widest.widest_m):
            others = self._screened([widest._replace(widest_m=np.inf)], seed)
            if others:
                tried.apart_m = min(other.width_m for other in others)
                tried.opening_m = widest.widest_m
                return
        if widest.askew_rad < np.pi:
            others = self._screened([widest._replace(askew_rad=np.pi)], seed)
            if others:
                tried.askew_deg = float(np.degrees(min(other.askew_rad for other in others)))
