"""A worker process that begins as a copy of this one, which has imported already what workers need.

A fresh interpreter takes a second or two of a core for that. But only a process with a single thread may be
copied: a lock that another thread holds would stay locked in the copy for ever. Threads that libraries have
started count as well.
"""

import contextlib
import contextvars
import gc
import os
import signal
import sys
import threading
import traceback
from typing import IO, Any, NoReturn

from .contract import WorkerSetup

__all__ = ["ForkedProcess", "can_fork"]

# Handlers of these are those of the process that was copied; one that is ignored stays so.
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def can_fork() -> bool:
    """Whether this process may be copied: it has one thread, as far as the system can tell."""
    try:
        return len(os.listdir("/proc/self/task")) == 1
    except OSError:  # only Linux tells
        return False


class ForkedProcess:
    """A copy of this process that does the jobs of a worker; of `subprocess.Popen` what a worker takes.

    Args:
        setup: of the worker. The copy has it, with all that this process has found out about it and keeps.

    Attributes:
        pid: its number.
        stdin: pipe to it.
        stdout: pipe from it.

    Raises:
        OSError: it could not be started.
    """

    def __init__(self, setup: WorkerSetup[Any, Any]) -> None:
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        try:
            self.pid = os.fork()
        except OSError:
            for end in (theirs_in, ours_out, ours_in, theirs_out):
                os.close(end)
            raise
        if self.pid == 0:
            _work(theirs_in, theirs_out, setup)
        os.close(theirs_in)
        os.close(theirs_out)
        self.stdin: IO[bytes] = os.fdopen(ours_out, "wb")
        self.stdout: IO[bytes] = os.fdopen(ours_in, "rb")
        self._code: int | None = None
        self._lock = threading.Lock()

    def poll(self) -> int | None:
        """How it has ended, as an exit code; None while it lives."""
        return self._waited(os.WNOHANG)

    def wait(self) -> int | None:
        """Waits for its end."""
        return self._waited(0)

    def kill(self) -> None:
        """Ends it."""
        with self._lock:
            if self._code is None:  # else another process may have its number
                os.kill(self.pid, signal.SIGKILL)

    def _waited(self, flags: int) -> int | None:
        with self._lock:
            if self._code is None:
                pid, status = os.waitpid(self.pid, flags)
                if pid == self.pid:
                    self._code = os.waitstatus_to_exitcode(status)
            return self._code


def _work(stdin: int, stdout: int, setup: WorkerSetup[Any, Any]) -> NoReturn:
    """What the copy does, from its first moment to its last."""
    try:
        # Nothing that was there before is ever taken apart here: it may own files that are closed below.
        gc.freeze()
        os.setsid()  # an interrupt from the keyboard is for the caller to answer
        for number in _SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, signal.SIG_DFL)
        os.dup2(stdin, 0)
        os.dup2(stdout, 1)
        # With the others' pipes open here, nobody would notice their end; nor are files and locks its own.
        for name in os.listdir("/proc/self/fd"):
            if int(name) > 2:
                with contextlib.suppress(OSError):
                    os.close(int(name))
        # Who has captured what is printed has done so with files that are closed now.
        sys.stderr = open(2, "w", buffering=1, encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
        # Late, or a fresh interpreter that is told to run that module would have imported it before.
        from .process import main

        contextvars.Context().run(main, setup)
    except BaseException:  # noqa: BLE001 - nothing of the caller's code above may go on here
        traceback.print_exc()
        os._exit(1)
    os._exit(0)
