"""What became of an object: tasks that were tried, and what refused the others."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..records import GraspRecord, RunRecord
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
        """What it came to, of those grasps that were tried; where none held, why."""
        grasps = [grasp for grasp in self.record.grasps if grasp.is_done]
        counts = (
            (len(grasps), "tried"),
            (sum(grasp.is_clear for grasp in grasps), "clear"),
            (len(self.record.good), "held"),
        )
        said = f"{self.task.name}: " + ", ".join(f"{count} {word}" for count, word in counts)
        if self.record.good and not self.record.firm:
            said += ", all of them narrowly"
        why = "" if self.record.good else _why(grasps)
        return f"{said} ({why})" if why else said


def _why(grasps: Sequence[GraspRecord]) -> str:
    """Which step refused how many grasps, none of which held."""
    sunk = [grasp for grasp in grasps if not grasp.is_clear]
    weak = [grasp for grasp in grasps if grasp.is_clear and grasp.is_untested]
    slipped = [grasp.hold for grasp in grasps if grasp.is_clear and grasp.hold and grasp.hold.directions]
    words = []
    if slipped:
        best = max(slipped, key=lambda hold: hold.held_count)
        directions = f"{best.held_count} of {len(best.directions)} directions"
        words.append(f"{len(slipped)} slip, held in {directions} at best")
    if weak:
        words.append(f"{len(weak)} can't carry the load")
    if sunk:
        pairs = Counter(grasp.clearance.worst_pair for grasp in sunk if grasp.clearance)
        pair = pairs.most_common(1)[0][0] if pairs else None
        words.append(f"{len(sunk)} sink in" + (f", most often {pair[0]} and {pair[1]}" if pair else ""))
    return "; ".join(words)


@dataclass(frozen=True)
class ObjectRun:
    """What became of an object.

    Attributes:
        attempts: the tasks that were tried, in their order.
        tried: what the search for contacts has looked at, for each number of contacts.
        folder: where the files of the object and its tasks lie.
        wanted: how many grasps were to hold.
        seconds: what each stage has taken: hand, mesh, search and runs.
    """

    attempts: tuple[Attempt, ...]
    tried: tuple[Tried, ...]
    folder: Path
    wanted: int = 1
    seconds: Mapping[str, float] = field(default_factory=dict)

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
    def is_enough(self) -> bool:
        """Whether no other set of contacts is needed: so many hold, and not all of them narrowly."""
        return self.held >= self.wanted and self.is_firm

    @property
    def best(self) -> Attempt | None:
        """The attempt with the most grasps that hold; None where none was made."""
        return max(self.attempts, key=lambda attempt: len(attempt.record.good), default=None)

    def __str__(self) -> str:
        """What was tried, a line each; where too little held, what refused the rest and what to change."""
        lines = [str(attempt) for attempt in self.attempts]
        if not self.is_enough:
            lines += [str(tried) for tried in self.tried if tried.sites or tried.covered > 0.0]
            if self.seconds:
                spent = ", ".join(f"{stage} {took_s:.0f} s" for stage, took_s in self.seconds.items())
                lines.append(f"time: {spent}")
            lines.append(f"{self._found}; {self._remedy()}")
        return "\n".join(lines)

    @property
    def _found(self) -> str:
        if not self.is_held:
            return "nothing held"
        narrowly = "" if self.is_firm else ", all of them narrowly"
        return f"{self.held} of {self.wanted} grasps wanted hold{narrowly}"

    def _remedy(self) -> str:
        furthest = max(self.tried, key=lambda tried: tried.tasks, default=None)
        if furthest is None:
            return "nothing was looked at in time: try a larger --budget"
        if not self.attempts:
            return furthest.remedy
        grasps = [grasp for attempt in self.attempts for grasp in attempt.record.grasps]
        if not grasps:
            return "no configuration was certified in time: try a larger --budget"
        if not any(grasp.is_done for grasp in grasps):
            return "no grasp was tried in time: try a larger --budget"
        if not any(grasp.is_clear for grasp in grasps):
            return "every configuration sinks into something: try a larger --budget, or another --hand"
        if self.is_held:
            return "for more, try a larger --budget"
        if not any(tried.carrying for tried in self.tried):
            return (
                f"the hand's force is too small for the weight at all places: try {furthest.more_contacts}"
                "a smaller --mass, or another --hand"
            )
        return (
            f"clear grasps slip or can't carry the load: try {furthest.more_contacts}a larger --budget, "
            "or a smaller --mass"
        )
