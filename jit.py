"""Inner loops compiled to machine code, which is kept between runs where some folder can be written."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

__all__ = ["compiled"]

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


def compiled(function: FunctionT) -> FunctionT:
    """Compiles `function` on its first call; division by zero gives inf or NaN, as in numpy.

    The kept machine code is renewed when the function's own file changes, and only then: so a compiled
    function may call others of its file, but none of another. Arguments that differ in type, in memory
    layout or in being writable are compiled for apart, at a second or so each: pass them alike.
    """
    try:
        return numba.njit(function, cache=True, error_model="numpy")
    except RuntimeError:  # neither the folder of the code nor a cache folder can be written
        return numba.njit(function, error_model="numpy")
