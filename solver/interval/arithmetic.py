"""Outward-rounded interval arithmetic; every operation that must round outward goes through this module.

An operation rounds to nearest first and is then widened by more than half a unit in the last place, by
the formula of Rump, Zimmermann, Boldo and Melquiond ("Computing predecessor and successor in rounding to
nearest", BIT 49, 2009), so an enclosure is at most one ulp wider than needed at either end. Intervals
are pairs of floats.

An end beyond all floats is infinite, and what is unknown is the whole line: no operation answers NaN, which
would compare false with everything, and so cut off or keep at random.
"""

import math
from functools import partial

import numpy as np

from ...base.machine.jit import compiled

__all__ = ["add", "div", "down", "mul", "power", "scale", "sqr", "sqrt_interval", "sub", "up"]

_PHI = 2.0**-53 * (1.0 + 2.0**-52)
_ETA = 2.0**-1074


@partial(compiled, inline=True)
def down(x: float) -> float:
    """A float at or below the true result that rounded to `x`; -inf where `x` is inf (overflow) or NaN."""
    low = x - (abs(x) * _PHI + _ETA)
    return low if low > -np.inf else -np.inf


@partial(compiled, inline=True)
def up(x: float) -> float:
    """A float at or above the true result that rounded to `x`; inf where `x` is -inf (overflow) or NaN."""
    high = x + (abs(x) * _PHI + _ETA)
    return high if high < np.inf else np.inf


@compiled
def add(al: float, au: float, bl: float, bu: float) -> tuple[float, float]:
    """[al, au] + [bl, bu]."""
    return down(al + bl), up(au + bu)


@compiled
def sub(al: float, au: float, bl: float, bu: float) -> tuple[float, float]:
    """[al, au] - [bl, bu]."""
    return down(al - bu), up(au - bl)


@compiled
def scale(c: float, al: float, au: float) -> tuple[float, float]:
    """The number c times [al, au]; an end at infinity times zero counts as zero."""
    if c == 0.0:
        return 0.0, 0.0
    if c > 0.0:
        return down(c * al), up(c * au)
    return down(c * au), up(c * al)


@compiled
def mul(al: float, au: float, bl: float, bu: float) -> tuple[float, float]:
    """[al, au] * [bl, bu]."""
    p, q, r, s = al * bl, al * bu, au * bl, au * bu
    # Zero times infinity; minima and maxima would skip it or not, depending on where it stands.
    if not ((p == p) & (q == q) & (r == r) & (s == s)):
        return -np.inf, np.inf
    return down(min(min(p, q), min(r, s))), up(max(max(p, q), max(r, s)))


@compiled
def sqr(al: float, au: float) -> tuple[float, float]:
    """[al, au] squared."""
    if al >= 0.0:
        return max(0.0, down(al * al)), up(au * au)
    if au <= 0.0:
        return max(0.0, down(au * au)), up(al * al)
    m = max(-al, au)
    return 0.0, up(m * m)


@compiled
def power(al: float, au: float, n: int) -> tuple[float, float]:
    """[al, au] to the power n >= 1."""
    if n % 2 == 0:
        bl, bu = sqr(al, au)
        n //= 2
    else:
        bl, bu = al, au
        if n == 1:
            return bl, bu
        sl, su = sqr(al, au)
        rl, ru = power(sl, su, n // 2)
        return mul(al, au, rl, ru)
    if n == 1:
        return bl, bu
    return power(bl, bu, n)


@compiled
def div(al: float, au: float, bl: float, bu: float) -> tuple[float, float]:
    """Hull of [al, au] / [bl, bu]; infinite ends where the divisor holds zero."""
    if bl > 0.0 or bu < 0.0:
        p, q, r, s = al / bl, al / bu, au / bl, au / bu
        if not ((p == p) & (q == q) & (r == r) & (s == s)):  # infinity by infinity
            return -np.inf, np.inf
        return down(min(min(p, q), min(r, s))), up(max(max(p, q), max(r, s)))
    if al <= 0.0 <= au or (bl == 0.0 and bu == 0.0):
        return -np.inf, np.inf
    # The dividend has one sign; a divisor that ends at zero leaves half a line.
    if bl == 0.0:
        return (down(al / bu), np.inf) if al > 0.0 else (-np.inf, up(au / bu))
    if bu == 0.0:
        return (-np.inf, up(al / bl)) if al > 0.0 else (down(au / bl), np.inf)
    return -np.inf, np.inf


@compiled
def sqrt_interval(al: float, au: float) -> tuple[float, float]:
    """Square root of [max(al, 0), au]."""
    low = 0.0 if al <= 0.0 else max(0.0, down(math.sqrt(al)))
    return low, up(math.sqrt(max(au, 0.0)))
