"""Values and bounds in words, rounded so that what is said stays true."""

from collections.abc import Callable

import numpy as np

__all__ = ["friction_down", "friction_up", "multiple_down", "multiple_up"]


def friction_up(friction: float) -> str:
    """Rounded up to four decimals."""
    return f"{np.ceil(friction * 1e4 - 1e-6) / 1e4:.4f}"


def friction_down(friction: float) -> str:
    """Rounded down to four decimals."""
    return f"{np.floor(friction * 1e4) / 1e4:.4f}"


def multiple_up(multiple: float) -> str:
    """Rounded up to four significant digits or so."""
    return _rounded(multiple, np.ceil)


def multiple_down(multiple: float) -> str:
    """Rounded down to four significant digits or so."""
    return _rounded(multiple, np.floor)


def _rounded(multiple: float, how: Callable[[float], float]) -> str:
    digits = max(0, 3 - int(np.floor(np.log10(max(multiple, 1e-9)))))
    return f"{how(multiple * 10.0**digits) / 10.0**digits:.{digits}f}"
