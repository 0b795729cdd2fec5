"""What became of an object: tasks that were tried, and what refused the others."""

from dataclasses import dataclass
from pathlib import Path

from ..records import RunRecord
from ..suggest import Tried

__all__ = ["Attempt", "ObjectRun"]


@dataclass(frozen=True)
class Attempt:
    """A task that was tried.

    Attributes:
        task: its file.
        record: of its run.
        folder: of its run; a later attempt takes the folder of one in which nothing held.
    """

    task: Path
    record: RunRecord
    folder: Path

    @property
    def is_held(self) -> bool:
        """Whether some grasp of it held."""
        return self.record.verdict == "held"

    def __str__(self) -> str:
        grasps = self.record.grasps
        counts = (
            (len(grasps), "certified"),
            (sum(grasp.is_clear for grasp in grasps), "clear"),
            (len(self.record.good), "held"),
        )
        return f"{self.task.name}: " + ", ".join(f"{count} {word}" for count, word in counts)


@dataclass(frozen=True)
class ObjectRun:
    """What became of an object.

    Attributes:
        attempts: the tasks that were tried, in their order.
        tried: what the search for contacts has looked at, for each number of contacts.
        folder: where the files of the object and its tasks lie.
        wanted: how many grasps were to hold.
    """

    attempts: tuple[Attempt, ...]
    tried: tuple[Tried, ...]
    folder: Path
    wanted: int = 1

    @property
    def held(self) -> int:
        """How many grasps held, over all tasks."""
        return sum(len(attempt.record.good) for attempt in self.attempts)

    @property
    def is_held(self) -> bool:
        """Whether some grasp held."""
        return self.held > 0

    @property
    def is_firm(self) -> bool:
        """Whether some grasp held, and not narrowly."""
        return any(attempt.record.firm for attempt in self.attempts)

    @property
    def best(self) -> Attempt | None:
        """The attempt with the most grasps that hold; None where none was made."""
        return max(self.attempts, key=lambda attempt: len(attempt.record.good), default=None)

    def __str__(self) -> str:
        """What was tried, a line each; where too little held, what refused the rest and what to change."""
        lines = [str(attempt) for attempt in self.attempts]
        if self.held < self.wanted:
            lines += [str(tried) for tried in self.tried if tried.sites or tried.covered > 0.0]
            found = f"{self.held} of {self.wanted} grasps wanted hold" if self.is_held else "nothing held"
            lines.append(f"{found}; {self._remedy()}")
        return "\n".join(lines)

    def _remedy(self) -> str:
        if not self.attempts:
            furthest = max(self.tried, key=lambda tried: tried.tasks, default=None)
            return (
                "nothing was looked at in time: try a larger --budget"
                if furthest is None
                else furthest.remedy
            )
        grasps = [grasp for attempt in self.attempts for grasp in attempt.record.grasps]
        if not grasps:
            return "no configuration was certified in time: try a larger --budget"
        if not any(grasp.is_clear for grasp in grasps):
            return "every configuration sinks into something: try other --contacts, or another --hand"
        if self.is_held:
            return "for more, try a larger --budget"
        return "clear grasps slip or can't carry the load: try --contacts 3, or a smaller --mass"
