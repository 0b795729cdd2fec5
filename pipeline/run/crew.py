"""Whoever does the jobs of a run: this process, or several that stay for all its stages."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as FutureTimeout
from contextlib import ExitStack
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Protocol, Self, TypeVar, cast

from ...base.machine.cancellation import Cancelled, cancellable
from ...base.machine.compile_clock import compile_s
from ...mjcf import HoldSettings
from ...mjcf.model import compiled_model
from ...objects import Task
from ...retraction import RetractionSettings, collision_model
from ...workers import Pool, can_fork, open_pool

__all__ = ["Crew", "CrewSetup", "CrewWorker", "Job"]

ResultT = TypeVar("ResultT")
ResultT_co = TypeVar("ResultT_co", covariant=True)

# Jobs that are handed out ahead of those whose turn it is, by worker: none of them waits for long.
_AHEAD = 2
# How often whoever waits for a process looks whether to go on.
_GLANCE_S = 0.1


class Job(Protocol[ResultT_co]):
    """A piece of a run; what becomes of it depends on the setup and the job alone."""

    def work(self, setup: "CrewSetup") -> ResultT_co:
        """Does it."""

    def given_up(self, setup: "CrewSetup") -> ResultT_co:
        """What becomes of it where it ended every process that began it."""


@dataclass(frozen=True, eq=False)
class CrewSetup:
    """What all jobs of a run have in common.

    Attributes:
        task: the task, whose values travel to each process once.
        hold: settings of the physical test.
        retraction: settings of retraction.
    """

    task: Task
    hold: HoldSettings
    retraction: RetractionSettings

    @property
    def shared(self) -> tuple[object, ...]:
        """The task, to which every configuration refers."""
        return (self.task,)

    def new_worker(self) -> "CrewWorker":
        """Makes the worker of a process."""
        return CrewWorker(self)

    def prepare(self) -> None:
        """Makes what all jobs need and this process keeps, for copies of it to have it, too."""
        collision_model(self.task)
        compiled_model(self.task, self.hold)

    def give_up(self, job: Job[Any], /) -> Any:
        """What becomes of a job that ended every process that worked on it."""
        return job.given_up(self)


class CrewWorker:
    """Does jobs, one at a time.

    Args:
        setup: what all jobs have in common.
    """

    def __init__(self, setup: CrewSetup):
        self._setup = setup

    def work(self, job: Job[Any], /) -> Any:
        """Does a job."""
        return job.work(self._setup)


class Crew:
    """Does the jobs of a run; leaving it as a context manager ends its processes, whatever they are at.

    What comes out does not depend on the number of workers, unless a process is lost three times over the
    same job (see `Job.given_up`).

    Args:
        setup: task and settings.
        workers: number of processes; with 1, this one does it all. They start when there is work for them, or
            when they are told to `get_ready`, where that takes a while.
    """

    def __init__(self, setup: CrewSetup, workers: int = 1):
        self._setup = setup
        self._workers = workers
        self._pool: Pool[Job[Any], Any] | None = None
        self._is_used = False
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()
        self._pool, self._is_used = None, False

    def get_ready(self, most: int) -> None:
        """Starts processes for work that is about to come, so that they are up by then.

        Where they can be copies of this one, they start when the work is there, and have what this one has
        loaded by then.

        Args:
            most: jobs that may come at once; one alone needs no process.
        """
        if self._workers > 1 and most > 1 and not can_fork():
            self._opened(most)

    def _opened(self, most: int) -> Pool[Job[Any], Any]:
        """The processes, no more than so many where they have to be started."""
        if self._pool is None:
            if can_fork():
                self._setup.prepare()
            self._pool = self._stack.enter_context(open_pool(self._setup, min(self._workers, most)))
        return self._pool

    def results(
        self,
        jobs: Sequence[Job[ResultT]],
        *,
        is_over: Callable[[], bool] = lambda: False,
        should_stop: Callable[[], bool] = lambda: False,
        meanwhile: Callable[[], bool] = lambda: False,
        at_end: Callable[[], bool] = lambda: False,
    ) -> Iterator[ResultT]:
        """What became of each job in their order, as soon as it is known.

        Args:
            jobs: what to do.
            is_over: whether no job should be begun any more; those that were begun are finished.
            should_stop: whether those that were begun should be given up, too.
            meanwhile: does a piece of other work where this process would wait; False where none is left.
            at_end: likewise, but only once another process has nothing left to do.
        """
        here = self._count_here(len(jobs))
        done = 0
        for result in self._alone(jobs[:here], is_over, should_stop):
            done += 1
            yield result
        if here == done < len(jobs):
            yield from self._together(jobs[here:], is_over, should_stop, meanwhile, at_end)

    def _count_here(self, count: int) -> int:
        """How many jobs this process does itself."""
        if self._workers == 1 or (self._pool is None and count < 2):
            return count
        # Where the solver had to be compiled, so has the rest: once and here, not in every process at once.
        return 1 if not self._is_used and compile_s() > 0.0 else 0

    def _alone(
        self, jobs: Sequence[Job[ResultT]], is_over: Callable[[], bool], should_stop: Callable[[], bool]
    ) -> Iterator[ResultT]:
        worker = self._setup.new_worker()
        for job in jobs:
            if is_over() or should_stop():
                return
            try:
                with cancellable(should_stop):
                    result = worker.work(job)
            except Cancelled:
                return
            yield cast(ResultT, result)

    def _together(
        self,
        jobs: Sequence[Job[ResultT]],
        is_over: Callable[[], bool],
        should_stop: Callable[[], bool],
        meanwhile: Callable[[], bool],
        at_end: Callable[[], bool],
    ) -> Iterator[ResultT]:
        pool = self._opened(len(jobs))
        self._is_used = True
        waiting: deque[Future[ResultT]] = deque()
        try:
            for job in jobs:
                if is_over() or should_stop():
                    break
                waiting.append(pool.submit(job))
                if len(waiting) >= _AHEAD * self._workers:
                    result = _first(waiting, is_over, should_stop, meanwhile)
                    if result is None:
                        return
                    yield result

            def other_work() -> bool:
                open_jobs = sum(not future.done() for future in waiting) + 1
                return meanwhile() or (open_jobs < self._workers and at_end())

            while waiting:
                result = _first(waiting, is_over, should_stop, other_work)
                if result is None:
                    return
                yield result
        finally:  # whoever has heard enough closes this
            for later in reversed(waiting):
                later.cancel()


def _first(
    waiting: "deque[Future[ResultT]]",
    is_over: Callable[[], bool],
    should_stop: Callable[[], bool],
    meanwhile: Callable[[], bool],
) -> ResultT | None:
    """Waits for the first of those that wait; None where it is not to be finished."""
    first = waiting.popleft()
    while not should_stop():
        if is_over():
            # From the last one on, so that none takes the place of one that is called off.
            for later in reversed(waiting):
                later.cancel()
            if first.cancel():
                return None
        if not first.done() and meanwhile():
            continue
        try:
            return first.result(timeout=_GLANCE_S)
        except FutureTimeout:
            continue
        except CancelledError:
            return None
    return None
