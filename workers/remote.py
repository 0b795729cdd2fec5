"""A worker in a process of its own, started again when that is lost."""

import contextlib
import os
import subprocess
import sys
import threading
from typing import Any, Generic, TypeVar, cast

from .contract import WorkerSetup
from .forked import ForkedProcess
from .limit import TimeOver
from .messages import Codec, ProcessLost, receive, send

__all__ = ["RemoteWorker", "WorkFailed"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")


class WorkFailed(Exception):
    """A worker, or the setup that was to make one, raised an error.

    Attributes:
        error: what it raised.
    """

    def __init__(self, error: Exception):
        super().__init__(error)  # from which it is made again in another process
        self.error = error


class RemoteWorker(Generic[JobT, ResultT]):
    """Has jobs done by a process.

    Args:
        codec: for messages.
        setup: pickled; what the process makes its worker from.
    """

    def __init__(self, codec: Codec, setup: bytes):
        self._codec, self._setup = codec, setup
        self._process: subprocess.Popen[bytes] | ForkedProcess | None = None
        self._copies: list[ForkedProcess] = []
        self._closed = False

    def copy_this(self, setup: WorkerSetup[JobT, ResultT]) -> None:
        """Copies this process, which has one thread, for `start` to take; else that starts a fresh one.

        Args:
            setup: what was pickled.
        """
        with contextlib.suppress(OSError):
            self._copies.append(ForkedProcess(setup))

    def start(self) -> None:
        """Starts the process and waits until its worker is made.

        Raises:
            ProcessLost: it could not be started, or died before.
            WorkFailed: the setup raised an error.
        """
        self._process = self._copy() or _new_process()
        if self._closed:  # while it was being started
            self._stop()
        try:
            self._answer(self._talk(self._setup))
        except WorkFailed:
            self._stop()
            raise

    def work(self, job: JobT, limit_s: float | None = None) -> ResultT:
        """Has the process do a job; starts one first where there is none.

        Args:
            job: what to do.
            limit_s: how long that may take; then the process is ended. None for no limit.

        Raises:
            ProcessLost: it died, or none could be started.
            TimeOver: it took too long.
            WorkFailed: the worker raised an error, or the setup did.
        """
        return cast(ResultT, self._answer(self.exchange(self._codec.encode(job), limit_s)))

    def exchange(self, message: bytes, limit_s: float | None = None) -> bytes:
        """`work`, with job and answer as the codec has them; an error of the worker is an answer, too."""
        if self._process is None:
            self.start()
        over = threading.Event()

        def end() -> None:
            over.set()
            process = self._process
            if process is not None:
                process.kill()

        timer = None if limit_s is None else threading.Timer(limit_s, end)
        if timer is not None:
            timer.daemon = True
            timer.start()
        try:
            return self._talk(message)
        except ProcessLost:
            if limit_s is not None and over.is_set():
                raise TimeOver(limit_s) from None
            raise
        finally:
            if timer is not None:
                timer.cancel()

    @property
    def pid(self) -> int | None:
        """Number of the process while it lives."""
        process = self._process
        return process.pid if process is not None and process.poll() is None else None

    def close(self) -> None:
        """Ends the process, and any that another thread is about to start."""
        self._closed = True
        self._stop()
        self._process = self._copy()
        self._stop()

    def _copy(self) -> ForkedProcess | None:
        """The copy that waits to be taken; None where there is none any more."""
        try:
            return self._copies.pop()
        except IndexError:
            return None

    def _stop(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            assert pipe is not None
            with contextlib.suppress(OSError):  # what was still to be written has no reader
                pipe.close()

    def _answer(self, received: bytes) -> Any:
        """What an answer holds."""
        done, answer = self._codec.decode(received)
        if not done:
            raise WorkFailed(answer)
        return answer

    def _talk(self, message: bytes) -> bytes:
        """The answer to a message; where the process is lost, none is left."""
        process = self._process
        if process is None:  # closed by another thread
            raise ProcessLost
        assert process.stdin is not None and process.stdout is not None
        try:
            send(process.stdin, message)
            return receive(process.stdout)
        except ProcessLost:
            self._stop()
            raise


def _new_process() -> "subprocess.Popen[bytes]":
    """An interpreter of its own.

    Raises:
        ProcessLost: it could not be started.
    """
    path = os.pathsep.join(p for p in sys.path if p)
    try:
        return subprocess.Popen(
            [sys.executable, "-m", f"{__package__}.process"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,  # an interrupt from the keyboard is for the caller to answer
        )
    except OSError:
        raise ProcessLost from None
