"""Inner loops compiled to machine code, which is kept between runs where some folder can be written.

numba keeps it beside the sources or, where these can't be written to, in the user's cache folder. The first
use after an installation compiles for a minute or so, which `compile_clock` tells apart from work.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeVar

import numba
from numba.core import event

from .compile_clock import clock

__all__ = ["compiled"]

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

# Of each file with compiled functions: a digest of it and of all files whose compiled functions it imports.
_digests: dict[str, str] = {}


class _Listener(event.Listener):
    """Tells the clock when numba begins to compile, and when it has done."""

    def on_start(self, event: Any) -> None:
        """Begins, perhaps within another one: a function compiles those that it calls."""
        del event
        clock.begin()

    def on_end(self, event: Any) -> None:
        """Ends the last that has begun."""
        del event
        clock.end()


event.register("numba:compile", _Listener())  # type: ignore[no-untyped-call]


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
