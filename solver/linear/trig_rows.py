"""Rows of the relaxation beside cosines and sines of (ratio x + offset): lines of four slopes each."""

import math

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ..enclosure import beside_line
from ..interval import COSINE, Interval
from ..polynomial import TrigFunctions

__all__ = ["ROWS_PER_TRIG", "trig_rows"]

ROWS_PER_TRIG = 4
# On an interval narrower than this, the chord's slope is rounding.
_NARROW = 1e-7


@compiled
def trig_rows(
    lower: Array, upper: Array, trig: TrigFunctions, r: int, t: int, value: Array, sides: Interval
) -> None:
    """Fills rows from number r on, entries from number t on, over the box [lower, upper].

    Slopes are those of the function at both ends and half way, and of its chord; x_k - slope x_i is bounded
    from below and above. Any slope gives a valid row, so slopes need not be exact.
    """
    row_lower, row_upper = sides
    for f in range(len(trig.ki)):
        i = trig.ki[f, 1]
        kind, ratio, offset = trig.kind[f], trig.ratio[f], trig.offset[f]
        a, b = lower[i], upper[i]
        for number in range(ROWS_PER_TRIG):
            if number == ROWS_PER_TRIG - 1 and b - a > _NARROW:
                slope = _rise(kind, ratio * a + offset, ratio * b + offset) / (b - a)
            else:
                x = a if number == 0 else b if number == 1 else 0.5 * (a + b)
                at = ratio * x + offset
                slope = -ratio * math.sin(at) if kind == COSINE else ratio * math.cos(at)
            value[t], value[t + 1] = 1.0, -slope
            row_lower[r], row_upper[r] = beside_line(kind, ratio, offset, slope, a, b)
            t, r = t + 2, r + 1


@compiled
def _rise(kind: int, al: float, au: float) -> float:
    """By how much cosine or sine rises from al to au."""
    if kind == COSINE:
        return math.cos(au) - math.cos(al)
    return math.sin(au) - math.sin(al)
