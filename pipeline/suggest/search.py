"""The search for contacts: rounds with ever more places and fingers, and more effort for each try."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ...base.machine.cancellation import Cancelled, cancellable
from ...base.machine.work_clock import WorkClock
from .growing import Grown, grown_sets
from .outcome import Outcome
from .prospects import Choice, Prospects
from .reach import Postures
from .screen import Combination, apart_m, can_ever_carry
from .suggestion import Suggestion
from .surface import Site
from .tried import Tried
from .trying import Effort, task_of, try_from, try_task

__all__ = ["Search"]

# Tries of a round.
_TRIES = 40
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


class Search:
    """A search for tasks of one number of contacts, which can be gone on with.

    Args:
        prospects: what its rounds look at.
        seed: the same seed tries the same in the same order.

    Attributes:
        prospects: what its rounds look at.
        tried: what was looked at so far.
        outcomes: of all tries, in their order.
        rounds: that were begun.
    """

    def __init__(self, prospects: Prospects, seed: int = 0):
        self.prospects, self._seed = prospects, seed
        self._hand, self._obj, self._contacts = prospects.hand, prospects.obj, prospects.contacts
        self.tried = Tried(self._contacts, most_contacts=prospects.most_contacts)
        self.outcomes: list[Outcome] = []
        self.rounds = 0
        self._done: set[tuple[tuple[Site, ...], tuple[str, ...] | None]] = set()
        self._known: deque[Outcome] = deque()
        self._order: Iterator[Suggestion | None] = iter(())

    def can_carry(self) -> bool:
        """Whether places were found that carry the object; looks at the first ones where nothing was yet."""
        if not can_ever_carry(self._hand, self._obj, self._contacts):
            return False
        if self.rounds == 0:
            self._order = self._tries_of_round()
            next(self._order)
        if self.prospects.weak_are_worth_a_try:
            return self.tried.combinations > 0
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
        self.prospects.look(k, seed, self.tried)
        choices = self.prospects.choices(k, seed)
        combinations = self.prospects.combinations(choices, seed, self.tried)
        self.tried.combinations, self.tried.choices = len(combinations), len(choices)
        self.tried.carrying = sum(combination.carries for combination in combinations)
        yield None  # so that time is looked at, and a round without combinations ends
        postures = Postures(self._hand, self.prospects.regions, seed)
        if pinches := self.prospects.pinches(k, seed):
            nearest = sorted(pinches, key=lambda pinch: postures.misfit_m(*pinch))[:_PINCHES]
            yield from self._grown(nearest)
        if not combinations:
            return
        worth = np.array([[self._worth(postures, c, choice) for choice in choices] for c in combinations])
        for _ in range(min(_TRIES, worth.size)):
            i, j = np.unravel_index(int(np.argmax(worth)), worth.shape)
            if worth[i, j] <= 0.0:
                return
            combination, choice = combinations[i], choices[j]
            room_deg = self.prospects.room_deg(k, combination, choice)
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

    def _try(self, make: Callable[[], Suggestion | Outcome]) -> tuple[Outcome, Suggestion | None]:
        """A try of a round, which counts; of one whose outcome is known from before, only that."""
        made = self._known.popleft() if self._known else make()
        outcome, found = (made, None) if isinstance(made, Outcome) else (Outcome("found"), made)
        self.outcomes.append(outcome)
        self.tried.count(outcome)
        return outcome, found

    def _grown(self, pinches: Sequence[tuple[Combination, Choice]]) -> Iterator["Suggestion | None"]:
        """Tries of contacts that are grown from pinches, those that carry the object first."""
        weak: list[tuple[Combination, Grown]] = []
        seen: list[Combination] = []
        tips = self.prospects.tips
        for found in grown_sets(self._hand, self._obj, tips, self._contacts, pinches, self._seed):
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

    def _worth(self, postures: Postures, combination: Combination, regions: Choice) -> float:
        """What a try promises, less where fingers seem not to reach; nothing a second time."""
        if not self._done.isdisjoint({(combination.sites, None), (combination.sites, _names(regions))}):
            return 0.0
        if not self.prospects.are_within_limits(combination, regions):
            return 0.0
        return combination.worth * float(np.exp(-postures.misfit_m(combination, regions) / _MISFIT_M))


_END = object()


def _names(regions: Choice) -> tuple[str, ...]:
    return tuple(region.name for region in regions)
