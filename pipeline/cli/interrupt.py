"""Signals that ask the command to end: Ctrl-C, and the same from other programs (SIGTERM, SIGHUP).

A command ends in one of three ways, the first of which leaves the most behind: it is asked to stop, and keeps
what it has found; a KeyboardInterrupt ends it, which undoes what was only begun; or the process just ends.
Nothing but the process itself is lost by the last one: files are written whole or not at all, and workers end
when their pipe is closed.
"""

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

__all__ = ["INTERRUPTED", "answered_by", "interrupting", "leave", "stop_on_interrupt"]

INTERRUPTED = 130
"""Exit code of a command that a signal has ended."""

# Where a signal is not known, as on Windows, nobody sends it.
_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
# After an interrupt the process ends by itself in this time, or is ended: a library may have swallowed it.
_UNWINDING_S = 1.5

Handler = Callable[[int, FrameType | None], object]


def leave(code: int) -> NoReturn:
    """Ends the process at once."""
    os._exit(code)


@contextmanager
def answered_by(handler: Handler) -> Iterator[None]:
    """Within it `handler` answers the signals; one that is ignored, as nohup has it, stays so."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread hears signals
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    heard = {number: old for number, old in before.items() if old not in (signal.SIG_IGN, None)}
    for number in heard:
        signal.signal(number, handler)
    try:
        yield
    finally:
        for number, old in heard.items():
            signal.signal(number, old)


@contextmanager
def interrupting() -> Iterator[None]:
    """Within it a signal raises KeyboardInterrupt; another one, or a while without end, ends the process."""
    with _unwinding() as at_end:

        def interrupt(number: int, frame: FrameType | None) -> None:
            del number, frame
            _interrupt(at_end)

        with answered_by(interrupt):
            yield


class _Unwinding(contextlib.ExitStack):
    """What is to be undone at the end of a command, and whether it was interrupted."""

    interrupted = False


@contextmanager
def _unwinding() -> Iterator[_Unwinding]:
    """Lets nothing but a KeyboardInterrupt out after one was raised.

    Compiled code makes other exceptions of it: it can come between its work and its answer.
    """
    with _Unwinding() as at_end:
        try:
            yield at_end
        except Exception as error:
            if at_end.interrupted:
                raise KeyboardInterrupt from error
            raise


def _interrupt(at_end: _Unwinding) -> None:
    """Raises KeyboardInterrupt; ends the process some time later unless `at_end` is left by then."""
    at_end.interrupted = True
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: leave(INTERRUPTED))
    timer = threading.Timer(_UNWINDING_S, leave, [INTERRUPTED])
    timer.daemon = True
    at_end.callback(timer.cancel)
    timer.start()
    raise KeyboardInterrupt


@contextmanager
def stop_on_interrupt(say: Callable[[str], None]) -> Iterator[Callable[[], bool]]:
    """Within it the first signal only makes the yielded function answer True; a second one interrupts."""
    asked = threading.Event()
    with _unwinding() as at_end:

        def ask(number: int, frame: FrameType | None) -> None:
            del number, frame
            if asked.is_set():
                _interrupt(at_end)
            asked.set()
            # Nothing can be said where the signal came while something was being written.
            with contextlib.suppress(RuntimeError, OSError):
                say("stopping; what is finished is kept (again: stop at once)")

        with answered_by(ask):
            yield asked.is_set
