"""Interval arithmetic on arrays.

An operation rounds to nearest, so the neighbouring floats enclose its true result.
"""

from typing import Any

import numpy as np

from ..base.numeric.arrays import Array

__all__ = ["divide", "down", "mul", "square", "up"]


def down(x: Any) -> Any:
    """The floats below."""
    return np.nextafter(x, -np.inf)


def up(x: Any) -> Any:
    """The floats above."""
    return np.nextafter(x, np.inf)


def mul(al: Any, au: Any, bl: Any, bu: Any) -> tuple[Array, Array]:
    """[al, au] [bl, bu]."""
    corners = np.stack([al * bl, al * bu, au * bl, au * bu])
    return down(corners.min(axis=0)), up(corners.max(axis=0))


def square(al: Array, au: Array) -> tuple[Array, Array]:
    """[al, au] squared."""
    least = np.maximum(np.maximum(al, -au), 0.0)
    most = np.maximum(-al, au)
    return np.maximum(down(least * least), 0.0), up(most * most)


def divide(al: Array, au: Array, bl: Array, bu: Array) -> tuple[Array, Array]:
    """[al, au] / [bl, bu]; nothing is known where the divisor changes sign or both hold zero."""
    # A zero at the divisor's end stands for the side on which the divisor lies.
    bl, bu = np.where(bl == 0.0, 0.0, bl), np.where(bu == 0.0, -0.0, bu)
    corners = np.stack([al / bl, al / bu, au / bl, au / bu])
    one_signed = (bl > 0.0) | (bu < 0.0) | (((al > 0.0) | (au < 0.0)) & ((bl >= 0.0) ^ (bu <= 0.0)))
    return (
        np.where(one_signed, down(corners.min(axis=0)), -np.inf),
        np.where(one_signed, up(corners.max(axis=0)), np.inf),
    )
