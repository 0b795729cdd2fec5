"""Inner loops compiled to machine code, which is kept between runs where some folder can be written.

numba keeps it beside the sources or, where these can't be written to, in the user's cache folder. The first
use after an installation compiles for a minute or so, which `compile_s` tells apart from work.
"""

import hashlib
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeVar

import numba
from numba.core import event

__all__ = ["compile_s", "compiled", "when_compiling"]

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

# Of each file with compiled functions: a digest of it and of all files whose compiled functions it imports.
_digests: dict[str, str] = {}


class _CompileClock(event.Listener):
    """The time that numba has compiled in this process; its lock lets no two threads compile at once."""

    def __init__(self) -> None:
        self.total_s = 0.0
        self.announce: Callable[[], object] | None = None
        self._depth = 0
        self._started = 0.0

    def on_start(self, event: Any) -> None:
        """A function compiles those that it calls, so starts are nested."""
        del event
        self._depth += 1
        if self._depth == 1:
            self._started = time.perf_counter()
            announce, self.announce = self.announce, None
            if announce is not None:
                announce()

    def on_end(self, event: Any) -> None:
        """Adds the time since the outermost start."""
        del event
        self._depth -= 1
        if self._depth == 0:
            self.total_s += time.perf_counter() - self._started


_clock = _CompileClock()
event.register("numba:compile", _clock)  # type: ignore[no-untyped-call]


def compile_s() -> float:
    """Time that this process has spent on compiling, in s; what was kept by earlier ones takes none."""
    return _clock.total_s


def when_compiling(announce: Callable[[], object] | None) -> None:
    """Has `announce` called once, when something is compiled that was not kept; None for nothing."""
    _clock.announce = announce


def compiled(function: FunctionT, *, inline: bool = False) -> FunctionT:
    """Compiles `function` on its first call; division by zero gives inf or NaN, as in numpy.

    No fastmath: it would let the compiler reorder operations, and break what is rounded outward.

    The kept machine code is renewed when the function's own file changes, or one whose compiled functions are
    called from there. These have to be imported by name, at the head of the file. Arguments that differ in
    type, memory layout or in being writable are compiled for apart, at a second or so each: pass them alike.

    Args:
        function: what to compile.
        inline: whether to copy it into its callers.
    """
    where: Literal["always", "never"] = "always" if inline else "never"
    try:
        dispatcher = numba.njit(function, cache=True, error_model="numpy", inline=where)
        _renew_with_callees(dispatcher, function)
    except (RuntimeError, AttributeError, OSError):
        # Neither the folder of the code nor a cache folder can be written, or this numba keeps its code in
        # another way, in which it might be stale.
        return numba.njit(function, error_model="numpy", inline=where)
    return dispatcher


def _renew_with_callees(dispatcher: Any, function: Callable[..., Any]) -> None:
    """Makes numba compare more than the function's own file when it looks for kept code.

    numba itself compares a stamp, of that file alone, which it keeps in its index; there is no public way to
    say what else the code depends on.
    """
    index = dispatcher._cache._cache_file
    index._source_stamp = (index._source_stamp, _digest(function))
    load = index._load_index

    def load_what_is_known() -> Any:
        try:
            return load()
        except (ImportError, AttributeError):
            # Kept for arguments of a class that has since been moved or renamed: numba looks it up first.
            return {}

    index._load_index = load_what_is_known


def _digest(function: Callable[..., Any]) -> str:
    path = function.__code__.co_filename
    if path not in _digests:
        callees = {
            value.py_func.__code__.co_filename
            for value in function.__globals__.values()
            if isinstance(value, numba.core.dispatcher.Dispatcher)
        }
        digest = hashlib.sha256(Path(path).read_bytes())
        for callee in sorted((callees - {path}) & _digests.keys()):
            digest.update(_digests[callee].encode())
        _digests[path] = digest.hexdigest()
    return _digests[path]
