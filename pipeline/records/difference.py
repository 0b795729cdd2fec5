"""In what two runs differ that makes them different runs."""

from collections.abc import Mapping
from dataclasses import dataclass

from .run import RunRecord

__all__ = ["Difference", "difference", "setting_difference"]


@dataclass(frozen=True)
class Difference:
    """A field in which two runs differ.

    Attributes:
        field: dotted path in `run.json`.
        ours: its value in the new run, in words.
        theirs: its value in the earlier one.
    """

    field: str
    ours: str
    theirs: str

    @property
    def words(self) -> str:
        """Why the earlier one can't be gone on with."""
        begun = "can't resume with other than what it was begun with"
        return f"is {self.theirs}, but {self.ours} is asked for now: {begun}"


def setting_difference(ours: Mapping[str, object], theirs: Mapping[str, object]) -> Difference | None:
    """The first setting in which two differ; None where they are the same."""
    for name in {**ours, **theirs}:
        if ours.get(name) != theirs.get(name):
            return Difference(name, _shown(ours.get(name)), _shown(theirs.get(name)))
    return None


def difference(ours: RunRecord, theirs: RunRecord) -> Difference | None:
    """The first of task, seed and settings in which two runs differ; None where they are the same run."""
    for name in ("task", "task_fingerprint", "seed"):
        if getattr(ours, name) != getattr(theirs, name):
            return Difference(name, _shown(getattr(ours, name)), _shown(getattr(theirs, name)))
    for name, value in ours.settings.items():
        if theirs.settings.get(name) != value:
            return Difference(f"settings.{name}", _shown(value), _shown(theirs.settings.get(name)))
    return None


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:80]}..."
