"""What compiled libraries print of their own accord."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["native_stdout_dropped"]


@contextmanager
def native_stdout_dropped() -> Iterator[None]:
    """Within it what compiled code prints to standard output goes nowhere.

    Python's own `print` is of no concern to it, unless another thread's is flushed meanwhile: keep it short.
    """
    try:
        kept = os.dup(1)
    except OSError:  # standard output is closed
        yield
        return
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
        _flush_native()
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.close(nothing)
        yield
    finally:
        _flush_native()
        os.dup2(kept, 1)
        os.close(kept)


def _flush_native() -> None:
    """Writes out what C's buffers hold: it would come out later, in the wrong place."""
    try:
        ctypes.CDLL(None).fflush(None)
    except (OSError, AttributeError, TypeError):  # no such library to be had, as on Windows
        return
