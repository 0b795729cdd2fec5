"""A search that can be looked at, left, shared among processes and gone on with: whatever is searched."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from contextlib import closing
from pathlib import Path
from typing import Generic, Self, TypeVar

from ...base.machine.work_clock import WorkClock
from ...workers import Worker, WorkerSetup
from .branch_and_prune import SearchState, Subtree, SubtreeResult, branch_and_prune
from .checkpoint import Checkpoint, Snapshot, pack_state, unpack_state
from .job_queue import JobQueue
from .result import Progress

__all__ = ["Session", "Stopwatch"]

BoxT = TypeVar("BoxT")
SolutionT = TypeVar("SolutionT")
JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")


class Stopwatch:
    """The time that a search takes, in one run or several.

    Attributes:
        earlier_s: time of earlier runs.
    """

    def __init__(self) -> None:
        self._clock = WorkClock()
        self.earlier_s = 0.0

    @property
    def seconds_here(self) -> float:
        """Time since the start, without earlier runs."""
        return self._clock.seconds

    @property
    def seconds(self) -> float:
        """Time since the start, that of earlier runs included."""
        return self.earlier_s + self.seconds_here


class Session(ABC, Generic[BoxT, SolutionT, JobT, ResultT]):
    """A search: its state, its workers, its clock and its file.

    A client says how boxes become jobs (`cut`, `lookahead`, `job`), how results are taken in (`take_in`), and
    what of its own belongs into a checkpoint (`snapshot`, `restore`).

    Args:
        setup: what decides the result of every job; worker processes are made from it.
        worker: does jobs in this process.
        state: of branch and prune, with nothing taken from it yet.
        workers: processes to use.
        watch: started when the search began.
        at_end: called when nothing is open any more.

    Attributes:
        setup: as given.
        worker: as given.
        state: of branch and prune.
        abandoned: boxes that were given up because every process that worked on them died.
    """

    setup: WorkerSetup[JobT, ResultT]
    worker: Worker[JobT, ResultT]

    def __init__(
        self,
        setup: WorkerSetup[JobT, ResultT],
        worker: Worker[JobT, ResultT],
        state: SearchState[BoxT, SolutionT],
        *,
        workers: int,
        watch: Stopwatch,
        at_end: Callable[[], None] = lambda: None,
    ):
        self.setup, self.worker, self.state = setup, worker, state
        self.abandoned = 0
        self._workers, self._watch, self._at_end = workers, watch, at_end
        self._checkpoint: Checkpoint | None = None

    @property
    def seconds(self) -> float:
        """Time since the start, that of earlier runs of a resumed search included."""
        return self._watch.seconds

    @property
    def progress(self) -> Progress:
        """Where the search stands."""
        state = self.state
        return Progress(
            boxes=state.processed,
            open=state.n_open,
            found=len(state.solutions),
            undecided=len(state.undecided),
            depth=state.depth,
            decided=state.decided,
            seconds=self.seconds,
        )

    def run(self) -> Generator[Self, None, None]:
        """Goes on; yields itself after each step until nothing is open, or it is of no use to go on.

        Closing the iterator ends all processes, and writes the checkpoint.
        """
        if self.is_endless():
            return
        jobs = JobQueue(self.setup, self.worker, self._workers)

        def begin(subtree: Subtree[BoxT]) -> Callable[[], SubtreeResult[BoxT, SolutionT]]:
            wait = jobs.submit(self.job(subtree))
            return lambda: self.take_in(wait())

        try:
            for _ in branch_and_prune(self.state, begin, cut=self.cut, lookahead=self.lookahead):
                if self._checkpoint is not None:
                    self._checkpoint.write_in_time()
                yield self
                if self.is_endless():
                    return
            self._at_end()
        finally:
            jobs.close()
            if self._checkpoint is not None:
                self._checkpoint.write()

    def finish(
        self,
        *,
        budget_s: float,
        should_stop: Callable[[], bool] | None = None,
        on_progress: Callable[[Progress], None] | None = None,
        enough: Callable[[], bool] = lambda: False,
    ) -> None:
        """Goes on until nothing is open, the time is over, or somebody has had enough.

        Args:
            budget_s: time after which the search stops; that of earlier runs doesn't count.
            should_stop: asked after each step; the search stops where it answers True.
            on_progress: called after each step.
            enough: asked before the first step and after each; the search stops where it answers True.
        """
        if enough():
            return
        with closing(self.run()) as steps:
            for _ in steps:
                if on_progress is not None:
                    on_progress(self.progress)
                late = self._watch.seconds_here > budget_s
                if enough() or late or (should_stop is not None and should_stop()):
                    return

    @abstractmethod
    def cut(self, box: BoxT, depth: int) -> Subtree[BoxT]:
        """The subtree to be searched below a box that is taken: its size, what it needs to know."""

    @abstractmethod
    def lookahead(self) -> int:
        """How many subtrees may be under way; must not depend on the number of processes, or on time."""

    @abstractmethod
    def job(self, subtree: Subtree[BoxT]) -> JobT:
        """What a worker is handed for a subtree: the same at any time after it was cut."""

    @abstractmethod
    def take_in(self, result: ResultT) -> SubtreeResult[BoxT, SolutionT]:
        """Adds a worker's result to what is known; what it returns is merged into the state."""

    @abstractmethod
    def is_endless(self) -> bool:
        """Whether to go on would be of no use, for boxes could be split for ever."""

    @abstractmethod
    def snapshot(self) -> Snapshot:
        """What belongs into a checkpoint beside boxes, counts and time: the solutions, say."""

    @abstractmethod
    def restore(self, saved: Snapshot) -> None:
        """Takes up what `snapshot` gave; boxes and counts of the state are there already."""

    def keep_in(
        self,
        path: str | Path,
        *,
        what: str,
        fingerprint: str,
        kind: type[BoxT],
        is_part: Callable[[BoxT, BoxT], bool],
        resume: bool,
    ) -> None:
        """Keeps the search in a file from now on.

        Args:
            path: the file.
            what: what is searched, in a word.
            fingerprint: of everything that decides the result: a file with another one is refused.
            kind: flat dataclass of the boxes.
            is_part: whether a box that was read lies in another, of those that the search begins with.
            resume: go on from the file, if there is one.

        Raises:
            InputError: the file exists and is not to be resumed, is damaged, belongs to another search, or
                can't be written.
        """

        def save() -> Snapshot:
            state, own = pack_state(self.state, kind), self.snapshot()
            session = {"abandoned": self.abandoned, "seconds": self.seconds}
            return Snapshot({**state.numbers, **session, **own.numbers}, {**state.arrays, **own.arrays})

        def restore(saved: Snapshot) -> None:
            begun = [entry[-1] for entry in self.state.frontier]
            unpack_state(saved, kind, self.state)
            for box in (*self.state.open_regions, *self.state.undecided):
                if not any(is_part(box, whole) for whole in begun):
                    raise ValueError("a box that is no part of the search")
            self.abandoned = int(saved.numbers["abandoned"])
            self._watch.earlier_s = float(saved.numbers["seconds"])
            self.restore(saved)

        self._checkpoint = Checkpoint(path, what, fingerprint, save, restore)
        self._checkpoint.open(resume)
