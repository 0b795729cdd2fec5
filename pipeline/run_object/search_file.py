"""`search.json`: what a search for contacts has come to, so that another process can go on with it."""

from pathlib import Path
from typing import Literal

from ...base.files.fields import Count, Finite, Name
from ...base.files.file_model import FileModel, parse
from ...base.files.json_file import read_json
from ...base.files.output_file import write_json
from ...errors import InputError
from ..records import Setting, setting_difference
from ..suggest import Outcome, Search, Step

__all__ = ["SEARCH_FILE", "SearchRecord", "TriedSet", "Turn", "read_search", "write_search"]

SEARCH_FILE = "search.json"


class Try(FileModel):
    """What came of a try; see `suggest.Outcome`."""

    step: Step
    blocking: list[tuple[str, str]] = []
    askew_deg: Finite | None = None

    @classmethod
    def of(cls, outcome: Outcome) -> "Try":
        """As a search has it."""
        return cls(step=outcome.step, blocking=list(outcome.blocking), askew_deg=outcome.askew_deg)

    @property
    def outcome(self) -> Outcome:
        """As a search takes it."""
        return Outcome(self.step, tuple(self.blocking), self.askew_deg)


class TriedSet(FileModel):
    """A set of contacts whose grasps were tried.

    Attributes:
        task: name of its task file, without suffix.
        folder: number of its run folder: 1 is the one that was asked for, others have theirs behind its name.
        state: `running`; `failed`, its record then lies beside the task file; or `held`, its record then lies
            in its run folder.
    """

    task: Name
    folder: Count
    state: Literal["running", "failed", "held"] = "running"


class Turn(FileModel):
    """A turn of the search with one number of contacts.

    Attributes:
        contacts: that number.
        rounds: that were begun by its end, in this and earlier turns.
        tries: in this turn.
        set: what it has found; None where it has found nothing.
    """

    contacts: Count
    rounds: Count
    tries: list[Try] = []
    set: TriedSet | None = None

    def replay(self, search: Search) -> bool:
        """Takes a search to the end of this turn; whether it can have been this one's."""
        return search.replay([entry.outcome for entry in self.tries], self.rounds)


class SearchRecord(FileModel):
    """`search.json`.

    Attributes:
        holdfast: version that wrote it.
        asked: all that the search depends on: hand, object, seed and settings.
        turns: so far.
    """

    holdfast: str
    asked: dict[str, Setting]
    turns: list[Turn] = []


def write_search(folder: Path, record: SearchRecord) -> None:
    """Writes the file, whole or not at all."""
    write_json(folder / SEARCH_FILE, record.model_dump(mode="json", exclude_defaults=True))


def read_search(folder: Path, fresh: SearchRecord) -> SearchRecord:
    """What an earlier process has left in a folder; a fresh record where that is nothing.

    Raises:
        InputError: it can't be read, or is of another search than the fresh one.
    """
    path = folder / SEARCH_FILE
    if not path.exists():
        return fresh
    earlier = parse(SearchRecord, read_json(path), path)
    if earlier.holdfast != fresh.holdfast:
        found = f"is {earlier.holdfast[:40]!r}, but this is {fresh.holdfast!r}"
        raise InputError(path, "holdfast", f"{found}: can't resume another version's search")
    asked = {name: earlier.asked.get(name) for name in fresh.asked}
    if found_difference := setting_difference(fresh.asked, asked):
        raise InputError(path, f"asked.{found_difference.field}", found_difference.words)
    return earlier
