"""Inner loops compiled to machine code, which is kept between runs where some folder can be written."""

from collections.abc import Callable
from typing import Any, Literal, TypeVar

import numba

__all__ = ["compiled"]

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


def compiled(function: FunctionT, *, inline: bool = False) -> FunctionT:
    """Compiles `function` on its first call; division by zero gives inf or NaN, as in numpy.

    No fastmath: it would let the compiler reorder operations, and break what is rounded outward.

    The kept machine code is renewed when the function's own file changes, and only then: after a change to a
    function that others call from another file (those of `solver/rounding.py`, above all), the kept code has
    to be deleted. Arguments that differ in type, in memory layout or in being writable are compiled for
    apart, at a second or so each: pass them alike.

    Args:
        function: what to compile.
        inline: whether to copy it into its callers.
    """
    where: Literal["always", "never"] = "always" if inline else "never"
    try:
        return numba.njit(function, cache=True, error_model="numpy", inline=where)
    except RuntimeError:  # neither the folder of the code nor a cache folder can be written
        return numba.njit(function, error_model="numpy", inline=where)
