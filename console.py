"""What the commands say: progress on stderr, results on stdout."""

import json
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TextIO

from .errors import InputError
from .files import write_json
from .plain_text import printable, printable_lines

__all__ = ["Console", "emit", "emit_json", "format_table", "mend_streams"]


class Console:
    """Progress lines for a person who waits; on a terminal the passing ones overwrite each other."""

    def __init__(self, *, quiet: bool = False, stream: TextIO | None = None):
        self._stream: TextIO = stream or sys.stderr
        self._quiet = quiet
        self._passing = False
        self._shown_at = 0.0
        self._is_terminal = self._stream.isatty()

    def say(self, text: str) -> None:
        """Writes a line that stays."""
        if self._quiet:
            return
        self._wipe()
        self._write(f"{printable(text)}\n")

    def pass_by(self, text: str) -> None:
        """Shows how far a step is: ten times a second on a terminal, and not at all elsewhere."""
        now = time.monotonic()
        if self._quiet or not self._is_terminal or now - self._shown_at < 0.1:
            return
        self._shown_at = now
        self._wipe()
        self._write(printable(text)[:110])
        self._passing = True

    def _wipe(self) -> None:
        if self._passing:
            self._write("\r\x1b[K")
            self._passing = False

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()


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
    """A text table; columns whose cells are all numbers (or a dash) stand flush right."""
    rows = [[printable(cell) for cell in row] for row in rows]
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    right = [all(_is_number(row[i]) for row in rows) for i in range(len(header))]
    lines = [
        "  ".join(
            cell.rjust(width) if flush else cell.ljust(width)
            for cell, width, flush in zip(row, widths, right, strict=True)
        ).rstrip()
        for row in [header, ["-" * width for width in widths], *rows]
    ]
    return "\n".join(lines)


def _is_number(cell: str) -> bool:
    return cell == "-" or cell.replace(".", "", 1).lstrip("+-").isdigit()
