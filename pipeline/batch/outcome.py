"""What became of an item, in a file of its own."""

from typing import Literal

from ...base.files.fields import Count, Finite
from ...base.files.file_model import FileModel
from ..records import RunRecord

__all__ = ["Outcome", "RunOutcome"]


class RunOutcome(FileModel):
    """One run of an item.

    Attributes:
        folder: the run folder, as a path from the batch's folder.
        task: the task's name.
        hand: the hand's name.
        object: the object's name.
        verdict: as in `run.json`.
        narrow: likewise.
        complete: likewise.
        solved: grasps that came from the solver to be tried.
        certified: how many of them are certified.
        clear: how many are clear.
        tested: how many came to a test.
        good: how many are certified, clear and held.
        left: how many were not tested, as enough hold.
        best: name of the best grasp; None where there is none.
        seconds: by stage.
    """

    folder: str
    task: str
    hand: str
    object: str
    verdict: Literal["held", "not held", "infeasible", "undecided"]
    narrow: bool
    complete: bool
    solved: Count
    certified: Count
    clear: Count
    tested: Count
    good: Count
    left: Count = 0
    best: str | None
    seconds: dict[str, Finite]

    @classmethod
    def of(cls, record: RunRecord, folder: str) -> "RunOutcome":
        """What counts of a run's record."""
        grasps = record.grasps
        return cls(
            folder=folder,
            task=record.task,
            hand=record.hand,
            object=record.object,
            verdict=record.verdict,
            narrow=record.narrow,
            complete=record.complete,
            solved=len(grasps),
            certified=sum(grasp.certified for grasp in grasps),
            clear=sum(grasp.is_clear for grasp in grasps),
            tested=sum(grasp.hold is not None and not grasp.is_untested for grasp in grasps),
            good=len(record.good),
            left=len(record.left_untested),
            best=grasps[0].id if grasps else None,
            seconds=record.seconds,
        )


class Outcome(FileModel):
    """`outcomes/<name>.json`.

    Attributes:
        reference: the item's.
        name: the item's.
        state: `done`; `failed`, where it can't be run; `too long`, where it did not end in time; `lost`,
            where every process that worked on it broke down.
        reason: why it is not done, in words.
        runs: of a task one, of a mesh one for each task that was tried and whose folder is there.
        seconds: wall-clock time of all.
    """

    reference: str
    name: str
    state: Literal["done", "failed", "too long", "lost"]
    reason: str = ""
    runs: list[RunOutcome] = []
    seconds: Finite = 0.0

    @property
    def good(self) -> int:
        """Grasps that are certified, clear and held."""
        return sum(run.good for run in self.runs)

    @property
    def verdict(self) -> str:
        """That of the best run, or the state where none was made."""
        best = max(self.runs, key=lambda run: run.good, default=None)
        return self.state if best is None or self.state != "done" else best.verdict
