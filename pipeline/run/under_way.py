"""A run under way: what it is made with, and how its record is kept."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from ...base.machine.pace import Pace
from ...base.machine.work_clock import WorkClock
from ...base.text.console import Console
from ...mjcf import HoldSettings
from ...objects import Task
from ..records import RunFolder, RunRecord
from ..report import Drawn, EarlierSet
from .crew import Crew
from .extras import HandedOn
from .settings import RunSettings

__all__ = ["RunUnderWay", "save", "save_in_time", "timed"]


@dataclass(frozen=True, eq=False)
class RunUnderWay:
    """What a run is made with.

    Attributes:
        task: the task.
        reference: name or path by which it can be loaded again; empty where it was built in Python.
        folder: the run folder.
        settings: what is asked for.
        console: where progress goes.
        should_stop: whether to end early.
        clock: started with the run.
        hold: settings of the hold test.
        crew: does what can be shared.
        earlier: sets of contacts that were run before this one in its place.
        drawn: what pictures show, by id, of the grasps that were made since this process took the run up.
        handed: by id, what tests that this process has heard of leave for extras.
        pace: of writing the record.
    """

    task: Task
    reference: str
    folder: RunFolder
    settings: RunSettings
    console: Console
    should_stop: Callable[[], bool]
    clock: WorkClock
    hold: HoldSettings
    crew: Crew
    earlier: tuple[EarlierSet, ...] = ()
    drawn: dict[str, Drawn] = field(default_factory=dict)
    handed: dict[str, HandedOn] = field(default_factory=dict)
    pace: Pace = field(default_factory=Pace)

    @property
    def remaining_s(self) -> float:
        """Time left in the budget."""
        return self.settings.budget_s - self.clock.seconds

    @property
    def is_over(self) -> bool:
        """Whether nothing new should be begun."""
        return self.should_stop() or self.remaining_s <= 0.0

    def gives_up(self, record: RunRecord) -> bool:
        """Whether so many grasps have failed, and none is held, that no others are tried."""
        after = self.settings.give_up_after
        return after is not None and not record.good and sum(g.is_done for g in record.grasps) >= after


def _verdict(record: RunRecord) -> Literal["held", "not held", "infeasible", "undecided"]:
    if record.good:
        return "held"
    if record.solve is None or record.solve.verdict == "undecided":
        return "undecided"
    if record.solve.verdict == "infeasible":
        return "infeasible"
    return "not held" if all(grasp.is_done for grasp in record.grasps) else "undecided"


def save(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """Writes the record, with its verdict; the record as it was written."""
    started_s = time.monotonic()
    narrow = bool(record.good) and not record.firm
    record = record.model_copy(update={"verdict": _verdict(record), "narrow": narrow})
    run.folder.save(record)
    run.pace.note(started_s)
    return record


def save_in_time(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """Writes the record unless that was done a moment ago.

    What a kill costs then is done again when the run is resumed, with the same result.
    """
    return save(run, record) if run.pace.is_due else record


def timed(record: RunRecord, stage: str, seconds: float) -> RunRecord:
    """The record with more time spent on a stage."""
    spent = {**record.seconds, stage: record.seconds.get(stage, 0.0) + seconds}
    return record.model_copy(update={"seconds": spent})
