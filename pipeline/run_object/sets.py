"""Sets of contacts, one after the other, with a note of each so that a later process can go on from there."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...base.text.console import Console
from ...errors import InputError
from ..suggest import Search, Suggestion, Tried
from .request import ObjectFiles
from .search_file import SEARCH_FILE, SearchRecord, TriedSet, Try, Turn, write_search

__all__ = ["Sets"]

# Tries of a search before the next number of contacts has its turn. Not a time, so that the same seed leads
# to the same sets on every machine as far as it gets.
_TRIES = 24


@dataclass
class Sets:
    """Sets of contacts that are found in turns, the fewest contacts first.

    Attributes:
        looking: searches, which have the turns.
        files: where task files are written.
        record: what is noted.
    """

    looking: Sequence[Search]
    files: ObjectFiles
    record: SearchRecord

    @property
    def tried(self) -> tuple[Tried, ...]:
        """What the searches have looked at."""
        return tuple(search.tried for search in self.looking)

    def replay(self) -> list[TriedSet]:
        """Takes the searches to where the record ends; the sets that were found until then.

        Raises:
            InputError: the record is not one of these searches.
        """
        for i, turn in enumerate(self.record.turns):
            search = self._whose_turn(i)
            if turn.contacts != search.tried.contacts or not turn.replay(search):
                path = self.files.folder / SEARCH_FILE
                raise InputError(path, f"turns.{i}", "is none of this search: remove the file to begin anew")
        return [turn.set for turn in self.record.turns if turn.set is not None]

    def find(
        self,
        folder: int,
        *,
        budget_s: float,
        should_stop: Callable[[], bool],
        console: Console,
    ) -> tuple[TriedSet, Suggestion] | None:
        """A turn of the search; the set that it has found, as a task file, or None.

        Args:
            folder: number of the run folder of a set.
            budget_s: time after which nothing new is tried.
            should_stop: asked between tries.
            console: where progress goes.
        """
        search = self._whose_turn(len(self.record.turns))
        console.say(f"looking for {search.tried.contacts} contacts")
        before = len(search.outcomes)
        found = search.more(
            1,
            budget_s=budget_s,
            tries=_TRIES,
            should_stop=should_stop,
            on_progress=lambda tried, kept: console.pass_by(f"  {tried} tried, {kept} reached"),
        )
        number = 1 + sum(turn.set is not None for turn in self.record.turns)
        chosen = None
        if found:
            chosen = TriedSet(task=self.files.write_task(found[0], number).stem, folder=folder)
        turn = Turn(
            contacts=search.tried.contacts,
            rounds=search.rounds,
            tries=[Try.of(outcome) for outcome in search.outcomes[before:]],
            set=chosen,
        )
        self._note([*self.record.turns, turn])
        return None if chosen is None else (chosen, found[0])

    def note(self, changed: TriedSet) -> None:
        """Notes what has become of a set."""
        self._note(
            [
                turn.model_copy(update={"set": changed})
                if turn.set is not None and turn.set.task == changed.task
                else turn
                for turn in self.record.turns
            ]
        )

    def _note(self, turns: list[Turn]) -> None:
        self.record = self.record.model_copy(update={"turns": turns})
        write_search(self.files.folder, self.record)

    def _whose_turn(self, number: int) -> Search:
        return self.looking[number % len(self.looking)]

    def record_path(self, chosen: TriedSet) -> Path:
        """Where the record of a set's run lies once the next set has its folder."""
        return self.files.folder / f"{chosen.task}.run.json"
