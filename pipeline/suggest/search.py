"""The search for contacts: rounds with ever more places and fingers, and more effort for each try."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import permutations
from math import perm

import numpy as np

from ...base.machine.cancellation import Cancelled, cancellable
from ...base.machine.work_clock import WorkClock
from ...errors import InputError
from ...hands import Hand, HandRegion
from ...objects import ObjectModel
from .growing import PINCH, Grown, grown_sets
from .outcome import Outcome
from .reach import Postures
from .screen import Combination, PairLimits, apart_m, can_ever_carry, screen
from .suggestion import Suggestion
from .surface import Site, edge_sites, named_sites, opposite_sites, surface_sites
from .tried import Tried
from .trying import Effort, task_of, try_from, try_task
from .width import Widths

__all__ = ["MOST_CONTACTS", "Search"]

# Places that each round adds, and combinations that it looks at.
_SURFACE, _EDGES, _COMBINATIONS = 96, 32, 40
_MOST_SITES = 480
# Places that others are looked for across from, where none go together.
_ACROSS = 48
# Tries of a round.
_TRIES = 40
# Choices of fingers looked at: of more, a sample.
_MOST_CHOICES = 60
_MOST_ORDERS = 5000
# Room for flat pads of simple hands on what is not parallel as they are, and what counts as parallel.
_ROOM_DEG, _PARALLEL_RAD = 2.0, 1e-4
MOST_CONTACTS = 5
"""Pairs of regions that a task has at most here."""
# A misfit of so much makes a try worth a third, and a failed try so much of those like it.
_MISFIT_M = 0.008
_AFTER_FAILURE_COMBINATION, _AFTER_FAILURE_CHOICE = 0.6, 0.9
_FIRST_EFFORT = Effort(candidates=4, boxes=12, cleared=2, restarts=5)
_LATER_EFFORT = Effort(candidates=6, boxes=60, cleared=3, restarts=12)
# Pinches of a round that further contacts are grown from.
_PINCHES = 40
# Tries of a round with what is grown, before other places have their turn.
_GROWN_TRIES = 12
# Grown contacts that are all so near to those of an earlier try are no others.
_SAME_M = 0.01
# Boxes take milliseconds each where the first local searches land. Where they don't, linear programs cut the
# boxes, and those of so many contacts take seconds for each: other places promise more in that time.
_MANY_CONTACTS, _SHARE_OF_BOXES = 5, 1 / 6

_Pinch = tuple[Combination, tuple[HandRegion, ...]]


class Search:
    """A search for tasks of one number of contacts, which can be gone on with.

    Args:
        hand: the hand; regions named `<finger>/tip` are its fingertips and come first.
        obj: the object.
        contacts: pairs of regions in a task.
        seed: the same seed tries the same in the same order.

    Attributes:
        tried: what was looked at so far.
        outcomes: of all tries, in their order.
        rounds: that were begun.

    Raises:
        InputError: the hand has regions on fewer links than contacts are asked for.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, contacts: int, seed: int = 0):
        self._hand, self._obj, self._contacts, self._seed = hand, obj, contacts, seed
        self._tips, self._regions = self._own_regions()
        self.tried = Tried(contacts, most_contacts=_most_contacts(hand))
        self.outcomes: list[Outcome] = []
        self.rounds = 0
        self._widths = Widths(hand, self._regions)
        self._sites: list[Site] = []
        self._new_sites: list[Site] = []
        self._done: set[tuple[tuple[Site, ...], tuple[str, ...] | None]] = set()
        self._known: deque[Outcome] = deque()
        self._order: Iterator[Suggestion | None] = iter(())

    def _own_regions(self) -> tuple[list[HandRegion], list[HandRegion]]:
        """The regions that come first, and all that may touch."""
        return _regions(self._hand, self._contacts)

    def can_carry(self) -> bool:
        """Whether places were found that carry the object; looks at the first ones where nothing was yet."""
        if not can_ever_carry(self._hand, self._obj, self._contacts):
            return False
        if self.rounds == 0:
            self._order = self._tries_of_round()
            next(self._order)
        return self.tried.carrying > 0

    def more(
        self,
        count: int,
        *,
        budget_s: float,
        tries: int | None = None,
        should_stop: Callable[[], bool] = lambda: False,
        on_progress: Callable[[int, int], None] | None = None,
    ) -> list[Suggestion]:
        """Up to `count` suggestions more; fewer only when time is over, or so many tries were made.

        A round counts as a try, so that rounds without places that go together come to an end. A try that is
        under way when time is over is given up, and made again where the search goes on.
        """
        clock = WorkClock()

        def is_over() -> bool:
            return clock.seconds >= budget_s or should_stop()

        found: list[Suggestion] = []
        made = 0
        while len(found) < count and made != tries and not is_over():
            with cancellable(is_over):
                tried = next(self._order, _END)
            if tried is _END:
                self._order = self._tries_of_round()
                continue
            made += 1
            if isinstance(tried, Suggestion):
                found.append(tried)
            if on_progress is not None:
                on_progress(self.tried.tasks, len(found))
        return found

    def replay(self, outcomes: Sequence[Outcome], rounds: int) -> bool:
        """Takes the search to where an earlier one was, without its tries.

        Args:
            outcomes: of the tries that are not made again.
            rounds: that were begun then, all in all.

        Returns:
            Whether they are those of this search, as far as that can be seen.
        """
        self._known.extend(outcomes)
        while self._known or self.rounds < rounds:
            if next(self._order, _END) is _END:
                if self.rounds >= rounds:
                    break
                self._order = self._tries_of_round()
        fits = not self._known
        self._known.clear()
        return fits

    def _tries_of_round(self) -> Iterator["Suggestion | None"]:
        """The tries of the next round, what promises most first; None for each that failed."""
        k, self.rounds = self.rounds, self.rounds + 1
        effort = self._effort(k)
        seed = self._seed + 1009 * k
        self._look_for_sites(k, seed)
        choices = self._choices(k, seed)
        combinations = self._screened(choices, seed)
        self.tried.combinations, self.tried.choices = len(combinations), len(choices)
        self.tried.carrying = sum(combination.carries for combination in combinations)
        yield None  # so that time is looked at, and a round without combinations ends
        postures = Postures(self._hand, self._regions, seed)
        if self._contacts > PINCH and not self._widths.are_known:
            yield from self._grown(self._pinches(k, seed, postures))
        if not combinations:
            return
        worth = np.array([[self._worth(postures, c, choice) for choice in choices] for c in combinations])
        for _ in range(min(_TRIES, worth.size)):
            i, j = np.unravel_index(int(np.argmax(worth)), worth.shape)
            if worth[i, j] <= 0.0:
                return
            combination, choice = combinations[i], choices[j]
            room_deg = self._room_deg(k, combination, choice)
            task = task_of(self._hand, self._obj, combination, choice, room_deg)
            try:
                outcome, found = self._try(partial(try_task, task, self._seed, effort))
            except Cancelled:
                yield None
                continue
            worth[i, j] = 0.0
            is_found = outcome.step == "found"
            self._done.add((combination.sites, None if is_found else _names(choice)))
            if is_found:
                worth[i] = 0.0
            else:
                worth[i] *= _AFTER_FAILURE_COMBINATION
                worth[:, j] *= _AFTER_FAILURE_CHOICE
            yield found

    def _effort(self, k: int) -> Effort:
        effort = _FIRST_EFFORT if k == 0 else _LATER_EFFORT
        if self._contacts < _MANY_CONTACTS:
            return effort
        return replace(effort, boxes=round(_SHARE_OF_BOXES * effort.boxes))

    def _screened(self, choices: list[tuple[HandRegion, ...]], seed: int) -> list[Combination]:
        """Sets of places for choices of fingers, with places across from others where there are none.

        Where there are none even then, what simple hands can't is noted.
        """
        limits = list(dict.fromkeys(self._limits(choice) for choice in choices)) or [PairLimits()]
        widest = max(limits)

        def screened(limits: list[PairLimits]) -> list[Combination]:
            return screen(
                self._hand, self._obj, self._sites, self._contacts, _COMBINATIONS, seed, limits=limits
            )

        if combinations := screened(limits):
            return combinations
        self._look_across()
        if combinations := screened(limits):
            return combinations
        self.tried.apart_m = None
        if np.isfinite(widest.widest_m) and (others := screened([widest._replace(widest_m=np.inf)])):
            self.tried.apart_m = min(other.width_m for other in others)
            self.tried.opening_m = widest.widest_m
        elif widest.askew_rad < np.pi and (others := screened([widest._replace(askew_rad=np.pi)])):
            self.tried.askew_deg = float(np.degrees(min(other.askew_rad for other in others)))
        return []

    def _try(self, make: Callable[[], Suggestion | Outcome]) -> tuple[Outcome, Suggestion | None]:
        """A try of a round, which counts; of one whose outcome is known from before, only that."""
        made = self._known.popleft() if self._known else make()
        outcome, found = (made, None) if isinstance(made, Outcome) else (Outcome("found"), made)
        self.outcomes.append(outcome)
        self.tried.count(outcome)
        return outcome, found

    def _grown(self, pinches: list[_Pinch]) -> Iterator["Suggestion | None"]:
        """Tries of contacts that are grown from pinches, those that carry the object first."""
        weak: list[tuple[Combination, Grown]] = []
        seen: list[Combination] = []
        for found in grown_sets(self._hand, self._obj, self._tips, self._contacts, pinches, self._seed):
            if found is None:
                yield None
                continue
            combination, grown = found
            if any(apart_m(combination, other) < _SAME_M for other in seen):
                continue
            seen.append(combination)
            if len(seen) > _GROWN_TRIES:
                break
            if combination.carries:
                yield from self._try_grown(combination, grown)
            else:
                weak.append((combination, grown))
        if not self.tried.carrying:
            for combination, grown in weak:
                yield from self._try_grown(combination, grown)

    def _try_grown(self, combination: Combination, grown: Grown) -> Iterator["Suggestion | None"]:
        task = task_of(self._hand, self._obj, combination, grown.regions)
        make = partial(try_from, task, grown.state, _FIRST_EFFORT)
        while True:
            try:
                _, found = self._try(make)
            except Cancelled:
                yield None
                continue
            yield found
            return

    def _pinches(self, k: int, seed: int, postures: Postures) -> list[_Pinch]:
        """Two of the round's places with two fingers each, those first that fingers seem to reach best."""
        search = Search(self._hand, self._obj, PINCH, seed)
        search._sites = list(self._new_sites)
        choices = search._choices(k, seed)
        pairs = [(c, choice) for c in search._screened(choices, seed) for choice in choices]
        return sorted(pairs, key=lambda pair: postures.misfit_m(*pair))[:_PINCHES]

    def _worth(self, postures: Postures, combination: Combination, regions: tuple[HandRegion, ...]) -> float:
        """What a try promises, less where fingers seem not to reach; nothing a second time."""
        if not self._done.isdisjoint({(combination.sites, None), (combination.sites, _names(regions))}):
            return 0.0
        limits = self._limits(regions)
        if combination.width_m > limits.widest_m or combination.askew_rad > limits.askew_rad:
            return 0.0
        return combination.worth * float(np.exp(-postures.misfit_m(combination, regions) / _MISFIT_M))

    def _limits(self, choice: tuple[HandRegion, ...]) -> PairLimits:
        """What two regions can touch, with room at both contacts for normals that don't face each other."""
        room_rad = 2.0 * np.radians(_ROOM_DEG)
        return PairLimits(self._widths.widest_m(choice), self._widths.askew_rad(choice) + room_rad)

    def _room_deg(self, k: int, combination: Combination, choice: tuple[HandRegion, ...]) -> float | None:
        """Room for normals at flat pads: where jaws or places are not parallel, and later for all jaws."""
        if not self._widths.are_known:
            return None
        is_askew = combination.askew_rad > self._widths.askew_rad(choice) + _PARALLEL_RAD
        return _ROOM_DEG if k > 0 or is_askew or not self._widths.are_parallel(choice) else None

    def _look_for_sites(self, k: int, seed: int) -> None:
        """Adds the places of a round; later ones have places on edges as well, and let go of the oldest."""
        new = named_sites(self._obj) if k == 0 else edge_sites(self._obj, _EDGES, seed)
        on_surface, self.tried.covered = surface_sites(self._obj, _SURFACE, seed)
        self._new_sites = new + on_surface
        self.tried.sites += len(self._new_sites)
        self._sites = (self._sites + self._new_sites)[-_MOST_SITES:]

    def _look_across(self) -> None:
        """Adds places straight across from some of those that there are."""
        new = opposite_sites(self._obj, self._sites[-_ACROSS:])
        self.tried.sites += len(new)
        self._sites = (self._sites + new)[-_MOST_SITES:]

    def _choices(self, k: int, seed: int) -> list[tuple[HandRegion, ...]]:
        """Choices of fingers, with a thumb where there is one; in every second round of all regions.

        Of simple hands all from the start: jaws have few, and their tips may be edges where pads are flat.
        """
        regions = self._tips if k % 2 == 0 and not self._widths.are_known else self._regions
        choices = [
            c for c in _ordered(regions, self._contacts, seed) if len({r.link for r in c}) == self._contacts
        ]
        with_thumb = [c for c in choices if any(_is_thumb(region) for region in c)]
        choices = with_thumb or choices
        if len(choices) <= _MOST_CHOICES:
            return choices
        chosen = np.random.default_rng(seed).choice(len(choices), _MOST_CHOICES, replace=False)
        return [choices[i] for i in sorted(chosen)]


_END = object()


def _regions(hand: Hand, contacts: int) -> tuple[list[HandRegion], list[HandRegion]]:
    """The fingertips, and all regions; the thumb first, as it opposes the others."""
    everything = sorted(hand.regions.values(), key=lambda region: not _is_thumb(region))
    tips = [region for region in everything if region.name.endswith("/tip")]
    if len({region.link for region in tips}) < contacts:
        tips = everything
    links = len({region.link for region in tips})
    if links < contacts:
        raise InputError(
            "suggest",
            "contacts",
            f"hand {hand.name} has regions on {links} links, so at most {links} contacts",
        )
    if contacts > MOST_CONTACTS:
        raise InputError("suggest", "contacts", f"must be at most {MOST_CONTACTS}, not {contacts}")
    return tips, everything


def _most_contacts(hand: Hand) -> int:
    """How many contacts a task of the hand can have here."""
    return min(MOST_CONTACTS, len({region.link for region in hand.regions.values()}))


def _ordered(regions: list[HandRegion], contacts: int, seed: int) -> Iterable[tuple[HandRegion, ...]]:
    """Regions in every order, or in orders drawn at random where they are very many."""
    if perm(len(regions), contacts) <= _MOST_ORDERS:
        return permutations(regions, contacts)
    rng = np.random.default_rng(seed)
    drawn = {tuple(rng.permutation(len(regions))[:contacts].tolist()) for _ in range(_MOST_ORDERS)}
    return [tuple(regions[i] for i in order) for order in sorted(drawn)]


def _is_thumb(region: HandRegion) -> bool:
    return region.name.startswith("thumb")


def _names(regions: tuple[HandRegion, ...]) -> tuple[str, ...]:
    return tuple(region.name for region in regions)
