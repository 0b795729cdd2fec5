"""What the commands say: progress on stderr, results on stdout."""

import json
import math
import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TextIO

from ...errors import InputError
from ..files.output_file import write_json
from . import text_table
from .plain_text import printable, printable_lines
from .significant import significant
from .terminal import has_colours, painted, terminal_width

__all__ = ["Console", "Count", "emit", "emit_json", "format_table", "mend_streams"]

# Between passing lines on a terminal; and how long a log stays silent at most.
_PAUSE_S, _SILENCE_S = 0.1, 15.0


class Console:
    """Progress lines for a person who waits, or for a log.

    On a terminal the passing ones overwrite each other; elsewhere one of them is written now and then.

    Args:
        quiet: say nothing.
        stream: where to; stderr unless given.
        clock: time in s.
    """

    def __init__(
        self,
        *,
        quiet: bool = False,
        stream: TextIO | None = None,
        clock: Callable[[], float] = time.monotonic,
    ):
        self._stream: TextIO = stream or sys.stderr
        self._quiet = quiet
        self._clock = clock
        self._passing = False
        self._is_terminal = self._stream.isatty()
        self._shown_at = -math.inf if self._is_terminal else clock()

    def say(self, text: str) -> None:
        """Writes a line that stays."""
        if self._quiet:
            return
        self._wipe()
        self._write(f"{printable(text)}\n")
        if not self._is_terminal:
            self._shown_at = self._clock()

    def pass_by(self, text: str) -> None:
        """Shows how far a step is: ten times a second on a terminal, elsewhere after so long a silence."""
        now = self._clock()
        pause = _PAUSE_S if self._is_terminal else _SILENCE_S
        if self._quiet or now - self._shown_at < pause:
            return
        self._shown_at = now
        if not self._is_terminal:
            self._write(f"{printable(text)}\n")
            return
        self._wipe()
        # One column less: in the last one some terminals break the line.
        self._write(printable(text)[: (terminal_width(self._stream) or 80) - 1])
        self._passing = True

    def count(self, what: str, total: int) -> "Count":
        """Shows how many of a known number are done from now on, how fast it goes, and what time is left."""
        return Count(self, what, total, self._clock)

    def _wipe(self) -> None:
        if self._passing:
            self._write("\r\x1b[K")
            self._passing = False

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()


class Count:
    """How many of a known number are done; made by `Console.count`."""

    def __init__(self, console: Console, what: str, total: int, clock: Callable[[], float]):
        self._console = console
        self._what = what
        self._total = total
        self._clock = clock
        self._started = clock()
        self.done = 0

    def step(self) -> None:
        """One more is done."""
        self.done += 1
        self.show()

    def show(self) -> None:
        """Shows it, at the console's pace."""
        self._console.pass_by(f"  {self}")

    def watching(self, ask: Callable[[], bool]) -> Callable[[], bool]:
        """The question, which is asked again and again in the meantime; each time is a time to show it."""

        def asked() -> bool:
            self.show()
            return ask()

        return asked

    def __str__(self) -> str:
        """Such as `drawing: 3 of 16, 0.5 a second, about 26 s left`."""
        seconds = self._clock() - self._started
        head = f"{self._what}: {self.done} of {self._total}"
        if not self.done or seconds <= 0.0:
            return f"{head}, {seconds:.0f} s"
        rate = self.done / seconds
        pace = f"{significant(rate, 2)} a second" if rate >= 1.0 else f"{significant(1.0 / rate, 2)} s each"
        left = (self._total - self.done) / rate
        return f"{head}, {pace}, about {_duration(left)} left"


def _duration(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def mend_streams() -> None:
    """Lets the null device stand for standard streams that are closed, as `>&-` closes one.

    The next file to be opened would take the place of such a stream, and get what libraries print.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free, and this is it
        if getattr(sys, name) is None:
            mode = "w" if descriptor else "r"
            setattr(sys, name, os.fdopen(descriptor, mode, encoding="utf-8", closefd=False))


def emit(text: str) -> None:
    """Writes lines to stdout; a reader that has left, as `head` does, is no error.

    Raises:
        InputError: they can't be written, for a device is full, say.
    """
    text = printable_lines(text)
    # What the terminal's encoding lacks is written as an escape.
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    text = text.encode(encoding, "backslashreplace").decode(encoding)
    if has_colours(sys.stdout):
        text = painted(text)
    try:
        sys.stdout.write(f"{text}\n")
        sys.stdout.flush()
    except OSError as error:
        # What is still buffered would fail again when Python exits.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            reason = (error.strerror or "unknown reason").lower()
            raise InputError("standard output", "", f"can't be written: {reason}") from None


def emit_json(target: str, data: Any) -> None:
    """Writes JSON whole or not at all to the file `target`, or to stdout where that is `-`."""
    if target == "-":
        # The one control character that JSON lets stand in strings.
        emit(json.dumps(data, indent=1, allow_nan=False).replace("\x7f", "\\u007f"))
    else:
        write_json(Path(target), data)


def format_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A text table for stdout; where that is a terminal, columns of words are folded to its width."""
    return text_table.format_table(header, rows, terminal_width(sys.stdout))
