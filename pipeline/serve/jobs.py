"""Requests, each done by a command in a process of its own, within limits of time and size."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from ...base.files.file_paths import ROOT_VARIABLE
from ...base.files.input_file import read_input
from ...errors import HoldfastError, InputError
from .verbs import read_request

__all__ = ["Answer", "Busy", "Jobs", "Overdue"]

_LARGEST_ANSWER = 128 * 1024 * 1024
_LARGEST_PICTURE = 32 * 1024 * 1024
_LONGEST_ERROR = 4000
# Between being asked to stop, which keeps what was found, and being ended.
_GRACE_S = 10.0
# Exit codes with which a command has an answer: found, infeasible, neither; and what there was when stopped.
_ANSWERED = (0, 3, 4, 130)


class Busy(HoldfastError):
    """As many requests as are allowed are being done."""


class Overdue(HoldfastError):
    """A request took more time than is allowed, and left no answer."""


@dataclass(frozen=True)
class Answer:
    """What came of a request.

    Attributes:
        code: the exit code of the command: 0 found, 3 proved infeasible, 4 neither, 130 stopped.
        result: what the command wrote with `--json`, or where its picture lies.
        picture: the bytes of a PNG.
    """

    code: int
    result: dict[str, Any]
    picture: bytes | None = None


class Jobs:
    """Does requests in a folder.

    Args:
        folder: where their files lie and their results go.
        longest_s: time that one may take.
        together: how many are done at the same time; more are refused.
    """

    def __init__(self, folder: Path, *, longest_s: float = 600.0, together: int = 1):
        self.folder = folder
        self._longest_s = longest_s
        self._slots = threading.BoundedSemaphore(together)
        self._running: set[subprocess.Popen[bytes]] = set()

    def do(self, verb: str, data: Mapping[str, object]) -> Answer:
        """Does a request.

        Raises:
            InputError: it can't be done as it is.
            Busy: others are being done.
            Overdue: it took too long.
            HoldfastError: the command broke down.
        """
        request = read_request(verb, data, self.folder)
        with self._slot():
            code, out, said = self._run(request.words())
        if code == 2:
            raise InputError(verb, "", said.removeprefix("holdfast: ") or "can't be done")
        if code not in _ANSWERED:
            raise HoldfastError(f"{verb}: the command broke down with exit code {code}")
        if request.picture is not None:
            path = self.folder / request.picture
            picture = read_input(path, _LARGEST_PICTURE, source=verb, field="picture", links=False)
            return Answer(code, {"picture": request.picture}, picture)
        if not out.strip():
            raise Overdue(f"{verb}: stopped after {self._longest_s:g} s without an answer: ask for less")
        return Answer(code, json.loads(out))

    def close(self) -> None:
        """Ends what is being done."""
        for process in list(self._running):
            _end(process)

    @contextmanager
    def _slot(self) -> Iterator[None]:
        if not self._slots.acquire(blocking=False):
            raise Busy("another request is being done: ask again later")
        try:
            yield
        finally:
            self._slots.release()

    def _run(self, words: list[str]) -> tuple[int, bytes, str]:
        """A command's exit code, its stdout, and the last line that it said."""
        environment = {name: value for name, value in os.environ.items() if name != ROOT_VARIABLE}
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            with subprocess.Popen(
                [sys.executable, "-P", "-m", "holdfast", *words],
                cwd=self.folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                start_new_session=True,
            ) as process:
                self._running.add(process)
                try:
                    code = self._wait(process)
                finally:
                    _end(process)
                    self._running.discard(process)
            lines = _read_end(err, _LONGEST_ERROR).decode("utf-8", "replace").strip().splitlines()
            return code, _read(out, _LARGEST_ANSWER), lines[-1] if lines else ""

    def _wait(self, process: "subprocess.Popen[bytes]") -> int:
        with suppress(subprocess.TimeoutExpired):
            return process.wait(self._longest_s)
        process.send_signal(signal.SIGTERM)
        with suppress(subprocess.TimeoutExpired):
            return process.wait(_GRACE_S)
        _end(process)
        process.wait()
        raise Overdue(f"stopped after {self._longest_s:g} s without an answer: ask for less")


def _end(process: "subprocess.Popen[bytes]") -> None:
    """Ends a command and the processes that it has started."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)


def _read(file: BinaryIO, largest: int) -> bytes:
    """What was written to a file, as far as it is not more than is allowed."""
    size = file.seek(0, os.SEEK_END)
    if size > largest:
        raise HoldfastError(f"the answer is larger than {largest >> 20} MiB: ask for less")
    file.seek(0)
    return file.read()


def _read_end(file: BinaryIO, longest: int) -> bytes:
    """The last of what was written to a file."""
    file.seek(max(0, file.seek(0, os.SEEK_END) - longest))
    return file.read()
