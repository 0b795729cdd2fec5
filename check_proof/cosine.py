"""Cosine and sine in whole numbers, each of which stands for so many times 2^-128.

The functions of the C library promise nothing of their errors, so none of them takes part.
"""

import math
from fractions import Fraction

__all__ = ["ERROR", "ONE", "PI", "cosine_and_sine", "to_units"]

_BITS = 128
ONE = 1 << _BITS
_GUARD_BITS = 32
# `cosine_and_sine` is off by less than this: by some 400 for arguments up to 1000, which are reduced by
# multiples of a pi that is off by less than one, and by 60 for the series.
ERROR = 1 << 12


def _arctan_of_inverse(n: int, one: int) -> int:
    """arctan(1 / n) in units of 1 / one, by its series."""
    total, power, k = 0, one // n, 0
    while power:
        total += (-power if k % 2 else power) // (2 * k + 1)
        power //= n * n
        k += 1
    return total


def _machin() -> int:
    """Pi = 16 arctan(1/5) - 4 arctan(1/239), rounded down."""
    one = ONE << _GUARD_BITS
    return (16 * _arctan_of_inverse(5, one) - 4 * _arctan_of_inverse(239, one)) >> _GUARD_BITS


PI = _machin()


def to_units(value: Fraction) -> int:
    """A number in units, rounded down."""
    return math.floor(value * ONE)


def cosine_and_sine(angle: int) -> tuple[int, int]:
    """Cosine and sine of an angle, whose size is below 1000 rad; all in units."""
    quarters = (2 * angle + PI // 2) // PI
    y = angle - quarters * PI // 2
    square = y * y >> _BITS
    cosine = sine = 0
    c, s, k = ONE, abs(y), 0
    while c or s:
        cosine, sine = (cosine - c, sine - s) if k % 2 else (cosine + c, sine + s)
        c = (c * square >> _BITS) // ((2 * k + 1) * (2 * k + 2))
        s = (s * square >> _BITS) // ((2 * k + 2) * (2 * k + 3))
        k += 1
    if y < 0:
        sine = -sine
    return ((cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine))[quarters % 4]
