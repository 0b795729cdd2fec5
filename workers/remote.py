"""A worker in a process of its own, started again when that is lost."""

import contextlib
import os
import subprocess
import sys
from typing import Any, Generic, TypeVar, cast

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
        super().__init__(str(error))
        self.error = error


class RemoteWorker(Generic[JobT, ResultT]):
    """Has jobs done by a process.

    Args:
        codec: for messages.
        setup: pickled; what the process makes its worker from.
    """

    def __init__(self, codec: Codec, setup: bytes):
        self._codec, self._setup = codec, setup
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False

    def start(self) -> None:
        """Starts the process and waits until its worker is made.

        Raises:
            ProcessLost: it could not be started, or died before.
            WorkFailed: the setup raised an error.
        """
        path = os.pathsep.join(p for p in sys.path if p)
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-m", f"{__package__}.process"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**os.environ, "PYTHONPATH": path},
                start_new_session=True,  # an interrupt from the keyboard is for the caller to answer
            )
        except OSError:
            raise ProcessLost from None
        if self._closed:  # while it was being started
            self._stop()
        try:
            self._talk(self._setup)
        except WorkFailed:
            self._stop()
            raise

    def work(self, job: JobT) -> ResultT:
        """Has the process do a job; starts one first where there is none.

        Raises:
            ProcessLost: it died, or none could be started.
            WorkFailed: the worker raised an error, or the setup did.
        """
        message = self._codec.encode(job)
        if self._process is None:
            self.start()
        return cast(ResultT, self._talk(message))

    @property
    def pid(self) -> int | None:
        """Number of the process while it lives."""
        process = self._process
        return process.pid if process is not None and process.poll() is None else None

    def close(self) -> None:
        """Ends the process, and any that another thread is about to start."""
        self._closed = True
        self._stop()

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

    def _talk(self, message: bytes) -> Any:
        """The answer to a message; where the process is lost, none is left."""
        process = self._process
        if process is None:  # closed by another thread
            raise ProcessLost
        assert process.stdin is not None and process.stdout is not None
        try:
            send(process.stdin, message)
            received = receive(process.stdout)
        except ProcessLost:
            self._stop()
            raise
        done, answer = self._codec.decode(received)
        if not done:
            raise WorkFailed(answer)
        return answer
