"""Where the slices of a search are worked on: here, or in worker processes once they are up."""

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Generic, TypeVar

from ...workers import Worker, WorkerPool, WorkerSetup

__all__ = ["Dispatcher"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

# Processes take a second to start, while the search goes on here; a search that ends sooner needs none.
_PATIENCE_S = 1.5


class _Job(Generic[JobT, ResultT]):
    """A slice that was handed in, and who works on it."""

    def __init__(self, one: JobT):
        self.slice = one
        self.future: Future[ResultT] | None = None
        self.result: ResultT | None = None

    @property
    def is_done(self) -> bool:
        return self.result is not None or (self.future is not None and self.future.done())

    def claim(self) -> bool:
        """Whether nobody has begun; if so, no process will."""
        return self.result is None and (self.future is None or self.future.cancel())


class Dispatcher(Generic[JobT, ResultT]):
    """Has slices worked on.

    Args:
        setup: what processes make their workers from.
        worker: does it in this process.
        workers: how many processes to use; with 1 all is done in this one.
    """

    def __init__(self, setup: WorkerSetup[JobT, ResultT], worker: Worker[JobT, ResultT], workers: int):
        self._setup, self._worker, self._count = setup, worker, workers
        self._started = time.perf_counter()
        self._jobs: deque[_Job[JobT, ResultT]] = deque()
        self.pool: WorkerPool[JobT, ResultT] | None = None

    def begin(self, one: JobT) -> Callable[[], ResultT]:
        """Hands a slice in; what this returns is to be called for the results in the same order."""
        self._jobs.append(_Job(one))
        self._hand_over()
        return self._next_result

    def close(self) -> None:
        """Ends all processes."""
        if self.pool is not None:
            self.pool.close()

    def _next_result(self) -> ResultT:
        """The result of the first job; until all processes are up, this one lends a hand."""
        first = self._jobs[0]
        while not first.is_done and not (self.pool is not None and self.pool.complete):
            job = next((job for job in self._jobs if job.claim()), None)
            if job is None:
                break
            job.result = self._worker.work(job.slice)
            self._hand_over()
        self._jobs.popleft()
        if first.result is not None:
            return first.result
        assert first.future is not None
        return first.future.result()

    def _hand_over(self) -> None:
        """Gives all that waits to the processes, if any is up."""
        if self._count < 2:
            return
        if self.pool is None and time.perf_counter() - self._started >= _PATIENCE_S:
            self.pool = WorkerPool(self._setup, self._count, caller_is_busy=True)
        if self.pool is not None and self.pool.ready:
            for job in self._jobs:
                if job.future is None and job.result is None:
                    job.future = self.pool.submit(job.slice)
