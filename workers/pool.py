"""Processes that share the work of a search; one that dies costs only the slice that it was working on.

Each is a program of its own with two pipes, so the death of one doesn't touch the others, and a script that
calls the solver needs no guard against being imported again. Processes hold nothing that matters: their
results are merged by the search, in its own order.
"""

import contextlib
import os
import pickle
import queue
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Generic, TypeVar, cast

from .contract import SearchSetup
from .messages import WorkerLost, decode, encode, receive, send

__all__ = ["WorkerPool", "available_cores"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

# A slice that ended so many processes is left undecided.
_MOST_LOSSES = 3


def available_cores() -> int:
    """Cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # only Linux knows
        return os.cpu_count() or 1


class _Worker(Generic[JobT, ResultT]):
    """One process, started again when it is lost."""

    def __init__(self, setup: SearchSetup[JobT, ResultT], started: bytes):
        self._setup, self._message = setup, started
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Starts the process and waits until it is ready.

        Raises:
            WorkerLost: it died before.
        """
        path = os.pathsep.join(p for p in sys.path if p)
        self._process = subprocess.Popen(
            [sys.executable, "-m", f"{__package__}.process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,  # an interrupt from the keyboard is for the search to answer
        )
        self._talk(self._message)

    def work(self, one: JobT) -> ResultT:
        """Has the process work on a slice.

        Raises:
            WorkerLost: it died; call `start` before the next slice.
        """
        answer = decode(self._talk(encode(one)), self._setup.task)
        if isinstance(answer, Exception):
            raise answer
        return cast(ResultT, answer)

    @property
    def pid(self) -> int | None:
        """Number of the process while it lives."""
        return self._process.pid if self._process is not None and self._process.poll() is None else None

    def stop(self) -> None:
        """Ends the process."""
        if self._process is None:
            return
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            assert pipe is not None
            with contextlib.suppress(OSError):  # what was still to be written has no reader
                pipe.close()

    def _talk(self, message: bytes) -> bytes:
        assert self._process is not None
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None and stdout is not None
        send(stdin, message)
        return receive(stdout)


class WorkerPool(Generic[JobT, ResultT]):
    """A number of workers, each of which is handed the next slice when it is free.

    Args:
        setup: what they work on.
        count: how many.
    """

    def __init__(self, setup: SearchSetup[JobT, ResultT], count: int):
        self._setup = setup
        started = pickle.dumps(setup, protocol=pickle.HIGHEST_PROTOCOL)
        self._workers = [_Worker(setup, started) for _ in range(count)]
        self._free: queue.SimpleQueue[_Worker[JobT, ResultT]] = queue.SimpleQueue()
        self._closed = False
        # One thread for each worker, which spends its time waiting for it.
        self._threads = ThreadPoolExecutor(count, thread_name_prefix="holdfast-worker")
        self._ready = threading.Event()
        self._complete = threading.Event()
        # The last one starts when the others are up: until then the search itself keeps a core busy.
        early = [self._threads.submit(self._boot, worker) for worker in self._workers[:-1]]
        self._threads.submit(self._boot_last, early)

    @property
    def ready(self) -> bool:
        """Whether some worker is up, so that `submit` doesn't wait for one to start."""
        return self._ready.is_set()

    @property
    def complete(self) -> bool:
        """Whether all workers are up, or as many as could be started, if any could."""
        return self._complete.is_set()

    @property
    def pids(self) -> list[int]:
        """Numbers of the processes that live."""
        return [pid for worker in self._workers if (pid := worker.pid) is not None]

    def submit(self, one: JobT) -> "Future[ResultT]":
        """Has a slice worked on by the first worker that is free."""
        return self._threads.submit(self._work, one)

    def close(self) -> None:
        """Ends all processes; slices that are not done are dropped."""
        self._closed = True
        self._threads.shutdown(wait=False, cancel_futures=True)
        self._stop_all()
        self._threads.shutdown(wait=True)
        self._stop_all()  # those that a thread was just starting

    def _stop_all(self) -> None:
        for worker in self._workers:
            worker.stop()

    def _boot_last(self, early: "list[Future[None]]") -> None:
        for other in early:
            other.result()
        self._boot(self._workers[-1])
        if self._ready.is_set():
            self._complete.set()

    def _boot(self, worker: _Worker[JobT, ResultT]) -> None:
        if self._closed:  # nobody should wait for a process to start that is of no use any more
            return
        try:
            worker.start()
        except (OSError, WorkerLost):
            worker.stop()
            return
        self._free.put(worker)
        self._ready.set()

    def _work(self, one: JobT) -> ResultT:
        worker = self._free.get()
        try:
            done = _until_done(worker, one, lambda: self._closed)
            return self._setup.give_up(one) if done is None else done
        finally:
            self._free.put(worker)


def _until_done(worker: _Worker[JobT, ResultT], one: JobT, is_closed: Callable[[], Any]) -> ResultT | None:
    """The slice's result, from the process at hand or those that take the place of a lost one.

    None where all are lost: it may hold solutions, and nobody lives to tell.
    """
    for _ in range(_MOST_LOSSES):
        try:
            return worker.work(one)
        except WorkerLost:
            if is_closed():
                raise
            worker.stop()
            _restart(worker)
    return None


def _restart(worker: _Worker[Any, Any]) -> None:
    try:
        worker.start()
    except (OSError, WorkerLost):
        worker.stop()  # the next attempt finds no process, and counts
