"""Runs of sets of contacts, which share one budget and one number of grasps that should hold."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...base.files.output_file import write_bytes, write_json
from ...base.machine.work_clock import WorkClock
from ...base.text.console import Console
from ...errors import InputError
from ..records import RunFolder, RunRecord, read_run, to_json
from ..report import VIEW_NAMES, EarlierSet, view_path
from ..run import RunSettings, free_folder, run_task
from .outcome import Attempt, ObjectRun
from .search_file import TriedSet
from .sets import Sets

__all__ = ["Clock", "Runs"]

# Share of the time that is left which one task may take.
_RUNNING = 0.6
# What is under way when the budget ends is given up after so much of it again and so many seconds.
_OVER, _OVER_S = 0.1, 5.0
# Grasps of a task that may fail before any is held. Then others are looked for: grasps of the same contacts
# tend to fail for the same reason.
_PATIENCE = 4


@dataclass
class Clock:
    """When to end.

    Attributes:
        budget_s: of the whole command, its reading and cutting of the mesh included.
        should_stop: whether someone asks to end early.
        spent: what has been spent of it.
        stages: what each stage has taken of that, in s.
    """

    budget_s: float
    should_stop: Callable[[], bool]
    spent: WorkClock = field(default_factory=WorkClock)
    stages: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def during(self, stage: str) -> Iterator[None]:
        """Counts what is done within it as that stage."""
        before_s = self.spent.seconds
        try:
            yield
        finally:
            took_s = self.spent.seconds - before_s
            self.stages[stage] = self.stages.get(stage, 0.0) + took_s

    @property
    def remaining_s(self) -> float:
        """Time left."""
        return self.budget_s - self.spent.seconds

    def leave_at_least(self, share: float) -> bool:
        """Sees to it that such a share of the budget is left; whether it had to grow for that."""
        lacking_s = share * self.budget_s - self.remaining_s
        self.budget_s += max(0.0, lacking_s)
        return lacking_s > 0.0

    @property
    def is_over(self) -> bool:
        """Whether nothing new should be begun."""
        return self.remaining_s <= 0.0 or self.should_stop()

    def is_long_over(self) -> bool:
        """Whether what is under way should be given up."""
        return self.remaining_s <= -(_OVER * self.budget_s + _OVER_S) or self.should_stop()


@dataclass
class Runs:
    """The runs of sets of contacts.

    Attributes:
        sets: that are tried.
        path: the run folder that was asked for.
        settings: of all runs together.
        clock: when to end.
        console: where progress goes.
        resume: whether runs that lie in the folders are gone on with.
        force: whether other runs that lie there are replaced.
        attempts: so far.
    """

    sets: Sets
    path: Path
    settings: RunSettings
    clock: Clock
    console: Console
    resume: bool
    force: bool
    attempts: list[Attempt] = field(default_factory=list)

    @property
    def outcome(self) -> ObjectRun:
        """What has become of the object so far."""
        wanted = max(1, self.settings.grasps_wanted)
        return ObjectRun(
            tuple(self.attempts), self.sets.tried, self.sets.files.folder, wanted, dict(self.clock.stages)
        )

    @property
    def next_folder(self) -> int:
        """Number of the folder for the next set: that of one that did not hold is free for it."""
        if not self.attempts:
            return 1
        last = self.attempts[-1]
        if not last.is_held:
            return self._number(last.folder)
        taken = max(self._number(attempt.folder) for attempt in self.attempts)
        return taken + 1 if self.force else self._number(free_folder(self.path))

    def take_up(self, chosen: TriedSet) -> None:
        """Takes up what an earlier process has left of a set: its record, or its run to go on with."""
        if chosen.state == "running":
            self.run(chosen)
            return
        folder = self._folder(chosen.folder)
        path = self.sets.record_path(chosen)
        record = read_run(path if chosen.state == "failed" else RunFolder(folder).record_path)
        self.attempts.append(Attempt(self.sets.files.task_file(chosen.task), record, folder))

    def run(self, chosen: TriedSet) -> None:
        """Runs a set, or goes on with its run."""
        file, folder = self.sets.files.task_file(chosen.task), self._folder(chosen.folder)
        done = self.outcome
        wanted = max(1, done.wanted - done.held) if self.settings.grasps_wanted else 0
        is_own = any(attempt.folder == folder for attempt in self.attempts)
        stops = self.settings.enough is not None
        settings = replace(
            self.settings,
            budget_s=max(1.0, _RUNNING * self.clock.remaining_s),
            give_up_after=_PATIENCE,
            wanted=None if stops else wanted,
            enough=wanted if stops else None,
        )
        with self.clock.during("runs"):
            record = run_task(
                self.sets.files.reference(file),
                folder,
                settings,
                resume=self.resume and _lies_in(folder, chosen.task),
                force=self.force or is_own,
                earlier=tuple(self._earlier()),
                console=self.console,
                should_stop=self.clock.is_long_over,
            )
        attempt = Attempt(file, record, folder)
        self.attempts.append(attempt)
        self.console.say(f"  {attempt}")
        if self.clock.is_over and not record.complete:
            return  # so that it is gone on with
        if not attempt.is_held:
            # The next set has the folder; the record keeps its task's file beside it.
            moved = record.model_copy(update={"task_source": file.name})
            write_json(self.sets.record_path(chosen), to_json(moved))
            self._keep_picture(record, folder, file)
        self.sets.note(chosen.model_copy(update={"state": "held" if attempt.is_held else "failed"}))

    def _keep_picture(self, record: RunRecord, folder: Path, task_file: Path) -> None:
        """Keeps the picture of the grasp that came farthest beside the task's file."""
        if record.grasps:
            front = view_path(RunFolder(folder).media, record.grasps[0].id, VIEW_NAMES[0])
            if front.is_file():
                write_bytes(task_file.with_suffix(".png"), front.read_bytes())

    def _earlier(self) -> Iterator[EarlierSet]:
        """Sets that did not hold, for the report of the next one."""
        for attempt in self.attempts:
            if not attempt.is_held:
                picture = attempt.task.with_suffix(".png")
                yield EarlierSet(attempt.task.stem, str(attempt), picture if picture.is_file() else None)

    def _folder(self, number: int) -> Path:
        return self.path if number == 1 else self.path.with_name(f"{self.path.name}_{number}")

    def _number(self, folder: Path) -> int:
        return 1 if folder == self.path else int(folder.name.removeprefix(f"{self.path.name}_"))


def _lies_in(folder: Path, task: str) -> bool:
    """Whether the run of a task lies in a folder, rather than that of another set."""
    try:
        return read_run(RunFolder(folder).record_path).task == task
    except InputError:
        return False
