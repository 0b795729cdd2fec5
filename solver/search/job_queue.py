"""The jobs of a search in their order: done here, or in worker processes once they are up."""

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Generic, TypeVar

from ...workers import Pool, Worker, WorkerSetup, open_pool

__all__ = ["PATIENCE_S", "JobQueue"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

# Processes take a second to start, while the search goes on here; a search that ends sooner needs none.
PATIENCE_S = 1.5


class _Entry(Generic[JobT, ResultT]):
    """A job that was handed in, and who does it."""

    def __init__(self, job: JobT):
        self.job = job
        self.future: Future[ResultT] | None = None
        self.result: ResultT | None = None

    @property
    def is_done(self) -> bool:
        return self.result is not None or (self.future is not None and self.future.done())

    def claim(self) -> bool:
        """Whether nobody has begun; if so, no process will."""
        return self.result is None and (self.future is None or self.future.cancel())


class JobQueue(Generic[JobT, ResultT]):
    """Has jobs done and gives their results in the order in which they were handed in.

    Args:
        setup: what processes make their workers from.
        worker: does jobs in this process.
        workers: how many processes to use; with 1 all is done in this one.
    """

    def __init__(self, setup: WorkerSetup[JobT, ResultT], worker: Worker[JobT, ResultT], workers: int):
        self._setup, self._worker, self._count = setup, worker, workers
        self._started = time.perf_counter()
        self._entries: deque[_Entry[JobT, ResultT]] = deque()
        self.pool: Pool[JobT, ResultT] | None = None

    def submit(self, job: JobT) -> Callable[[], ResultT]:
        """Hands a job in; what this returns is to be called for the results in the same order."""
        self._entries.append(_Entry(job))
        self._hand_over()
        return self._next_result

    def close(self) -> None:
        """Ends all processes."""
        if self.pool is not None:
            self.pool.close()

    def _next_result(self) -> ResultT:
        """The result of the first job; until all processes are up, this one does jobs too."""
        first = self._entries[0]
        while not first.is_done and not (self.pool is not None and self.pool.complete):
            entry = next((entry for entry in self._entries if entry.claim()), None)
            if entry is None:
                break
            entry.result = self._worker.work(entry.job)
            self._hand_over()
        self._entries.popleft()
        if first.result is not None:
            return first.result
        assert first.future is not None
        return first.future.result()

    def _hand_over(self) -> None:
        """Gives all that waits to the processes, if any is up."""
        if self._count < 2:
            return
        if self.pool is None and time.perf_counter() - self._started >= PATIENCE_S:
            self.pool = open_pool(self._setup, self._count, caller_is_busy=True)
        if self.pool is not None and self.pool.ready:
            for entry in self._entries:
                if entry.future is None and entry.result is None:
                    entry.future = self.pool.submit(entry.job)
