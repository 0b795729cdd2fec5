"""A pool of processes that do jobs; one that dies costs only the job that it was doing.

Each is a process of its own with two pipes, so the death of one doesn't touch the others, and a script that
uses a pool needs no guard against being imported again. They begin as copies of this process where it has a
single thread, else, and in place of lost ones, as fresh interpreters. Nothing is shared but messages: there
are no semaphores, no locks and no shared memory that the machine might lack.
"""

import os
import pickle
import queue
import threading
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from types import TracebackType
from typing import Generic, Self, TypeVar

from .contract import WorkerSetup
from .forked import can_fork
from .messages import Codec, ProcessLost
from .remote import RemoteWorker, WorkFailed

__all__ = ["MOST_LOSSES", "WorkerPool", "available_cores"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

MOST_LOSSES = 3
"""A job that ended so many processes is given up."""


def available_cores() -> int:
    """Cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # only Linux knows
        return os.cpu_count() or 1


class WorkerPool(Generic[JobT, ResultT]):
    """A number of worker processes, each of which is handed the next job when it is free.

    Processes start when the pool is made, while the caller goes on. Leaving the pool as a context manager
    closes it.

    Args:
        setup: what all workers have in common.
        count: how many processes.
        caller_is_busy: start the last process when the others are up, for the caller does jobs itself until
            then and keeps a core busy with that.
        limit_s: how long a job may take; see `submit`. None for no limit.

    Raises:
        TypeError, pickle.PicklingError, AttributeError: the setup can't be pickled.
    """

    def __init__(
        self,
        setup: WorkerSetup[JobT, ResultT],
        count: int,
        *,
        caller_is_busy: bool = False,
        limit_s: float | None = None,
    ):
        self._setup, self._limit_s = setup, limit_s
        codec, pickled = Codec(setup.shared), pickle.dumps(setup, protocol=pickle.HIGHEST_PROTOCOL)
        self._workers: list[RemoteWorker[JobT, ResultT]] = [
            RemoteWorker(codec, pickled) for _ in range(count)
        ]
        if can_fork():  # soon it has more threads
            for worker in self._workers:
                worker.copy_this(setup)
        self._free: queue.SimpleQueue[RemoteWorker[JobT, ResultT]] = queue.SimpleQueue()
        self._closed = False
        self._ready = threading.Event()
        self._complete = threading.Event()
        # One thread for each process, which spends its time waiting for it.
        self._threads = ThreadPoolExecutor(count, thread_name_prefix="holdfast-worker")
        first = [self._threads.submit(self._boot, worker) for worker in self._workers[:-1]]
        self._threads.submit(self._boot_last, first, caller_is_busy)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def ready(self) -> bool:
        """Whether some process is up, so that a job doesn't wait for one to start."""
        return self._ready.is_set()

    @property
    def complete(self) -> bool:
        """Whether all processes are up, or as many as could be started, if any could."""
        return self._complete.is_set()

    def wait_until_complete(self, timeout_s: float) -> bool:
        """Waits until the pool is complete; False where it isn't by then."""
        return self._complete.wait(timeout_s)

    @property
    def pids(self) -> list[int]:
        """Numbers of the processes that live."""
        return [pid for worker in self._workers if (pid := worker.pid) is not None]

    def submit(self, job: JobT) -> "Future[ResultT]":
        """Has a job done by the first process that is free.

        The future gives the worker's result. Where the process is lost, another one begins the job anew;
        after three losses the result is the setup's `give_up(job)`. It raises what the worker, or the making
        of a worker where none could be made, has raised; `TimeOver` where the job took longer than the
        pool's limit, which costs its process; and `CancelledError` where the pool was closed before the job
        was done.
        """
        return self._threads.submit(self._work, job)

    def close(self) -> None:
        """Ends all processes; jobs that are not done are cancelled. Closing again does nothing."""
        self._closed = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        for worker in self._workers:
            worker.close()
        self._threads.shutdown(wait=True)

    def _boot_last(self, first: "list[Future[None]]", wait: bool) -> None:
        if not wait:
            self._boot(self._workers[-1])
        for other in first:
            other.result()
        if wait:
            self._boot(self._workers[-1])
        if self._ready.is_set():
            self._complete.set()
            return
        # None could be started. Each job tries anew, so that its future doesn't wait for ever.
        for worker in self._workers:
            self._free.put(worker)

    def _boot(self, worker: RemoteWorker[JobT, ResultT]) -> None:
        if self._closed:
            return
        try:
            worker.start()
        except (ProcessLost, WorkFailed):
            return  # the others do its share
        self._free.put(worker)
        self._ready.set()

    def _work(self, job: JobT) -> ResultT:
        worker = self._free.get()
        try:
            return self._until_done(worker, job)
        except WorkFailed as failure:
            raise failure.error from None
        finally:
            self._free.put(worker)

    def _until_done(self, worker: RemoteWorker[JobT, ResultT], job: JobT) -> ResultT:
        """The job's result, from the process at hand or those that take the place of a lost one."""
        for _ in range(MOST_LOSSES):
            if self._closed:
                raise CancelledError
            try:
                return worker.work(job, self._limit_s)
            except ProcessLost:
                continue
        if self._closed:
            raise CancelledError
        return self._setup.give_up(job)
