"""Cosine and sine of (ratio x + offset) over an interval of x: values, slopes and what they say of x.

Which of the two is a number, `COSINE` or `SINE`; the ratio is above zero. Ends are rounded outward. Where the
function reaches a value is guessed by the C library and then proved by an enclosure, so a wrong guess only
costs a cut.
"""

import math

import numpy as np

from ...base.machine.jit import compiled
from ..interval import COSINE, SINE, add, scale, trig_range

__all__ = ["trig_inputs", "trig_slope", "trig_value"]

# How far from the guess a cut is tried, nearest first; the guess is off by some units in the last place.
_STEPS_BACK = (1e-12, 1e-9, 1e-6)


@compiled
def trig_value(kind: int, ratio: float, offset: float, xl: float, xu: float) -> tuple[float, float]:
    """Enclosure of the function over [xl, xu]."""
    al, au = scale(ratio, xl, xu)
    al, au = add(al, au, offset, offset)
    return trig_range(kind, al, au)


@compiled
def trig_slope(kind: int, ratio: float, offset: float, xl: float, xu: float) -> tuple[float, float]:
    """Enclosure of the derivative by x over [xl, xu]."""
    if kind == COSINE:
        lo, hi = trig_value(SINE, ratio, offset, xl, xu)
        return scale(-ratio, lo, hi)
    lo, hi = trig_value(COSINE, ratio, offset, xl, xu)
    return scale(ratio, lo, hi)


@compiled
def trig_inputs(
    kind: int, ratio: float, offset: float, kl: float, ku: float, xl: float, xu: float
) -> tuple[float, float]:
    """The part of [xl, xu] where the function may lie in [kl, ku], as a hull; empty as (inf, -inf)."""
    for side in (0, 1):
        end = xl if side == 0 else xu
        lo, hi = trig_value(kind, ratio, offset, end, end)
        if hi >= kl and lo <= ku:
            continue
        level = kl if hi < kl else ku
        if not abs(level) <= 1.0:
            return np.inf, -np.inf
        guess = _reached(kind, ratio, offset, level, end, side)
        if not xl <= guess <= xu:
            if _misses(kind, ratio, offset, kl, ku, xl, xu):
                return np.inf, -np.inf
            continue
        for back in _STEPS_BACK:
            cut = guess - back if side == 0 else guess + back
            if not xl < cut < xu:
                break
            if side == 0 and _misses(kind, ratio, offset, kl, ku, xl, cut):
                xl = cut
                break
            if side == 1 and _misses(kind, ratio, offset, kl, ku, cut, xu):
                xu = cut
                break
    return xl, xu


@compiled
def _misses(kind: int, ratio: float, offset: float, kl: float, ku: float, xl: float, xu: float) -> bool:
    lo, hi = trig_value(kind, ratio, offset, xl, xu)
    return hi < kl or lo > ku


@compiled
def _reached(kind: int, ratio: float, offset: float, level: float, end: float, side: int) -> float:
    """About where the function comes to a level, going from `end` upwards (side 0) or downwards (1)."""
    shift = 0.0 if kind == COSINE else 0.5 * math.pi
    base = math.acos(level)
    start = ratio * end + offset - shift
    nearest = np.inf
    for angle in (base, -base):
        turns = (start - angle) / (2.0 * math.pi)
        turns = math.ceil(turns) if side == 0 else math.floor(turns)
        nearest = min(nearest, abs(angle + 2.0 * math.pi * turns - start))
    return end + nearest / ratio if side == 0 else end - nearest / ratio
