"""Cosine and sine in interval arithmetic: argument reduction and Taylor's formula with its remainder.

No function of the C library takes part, for none of them promises how far its results are off.
"""

import math

import numpy as np

from ...base.machine.jit import compiled
from .arithmetic import down, mul, scale, sqr, sub, up

__all__ = ["COSINE", "SINE", "trig_range"]

# Which function, as numbers that compiled loops and files take.
COSINE, SINE = 0, 1

# pi / 2 in two parts: the first 31 bits, of which a multiple below 2^20 is a float, and the rest enclosed.
_HALF_PI_FRONT = 1.5707963267341256
_REST_LOWER, _REST_UPPER = 6.077100506506192e-11, 6.077100506506194e-11
# Arguments beyond this (rad) count as unknown.
_FARTHEST = 1e4
# Reduced arguments are below 0.8 in size: Taylor polynomials up to y^16 and y^17 are off by less than these,
# 0.8^18 / 18! and 0.8^19 / 19!.
_COSINE_REMAINDER, _SINE_REMAINDER = 1e-17, 1e-18
_PAIRS_OF_TERMS = 8
# A peak counts as inside an interval that ends so much before it (in turns by pi): the value there is within
# 1e-17 of the peak's, and the place of the peak is rounded by far less.
_PEAK_ROOM = 1e-9


@compiled
def _cosine_and_sine(x: float) -> tuple[float, float, float, float]:
    """Enclosures (cl, cu, sl, su) of cosine and sine at a number; about 1.4e-15 wide."""
    if not abs(x) < _FARTHEST:
        return -1.0, 1.0, -1.0, 1.0
    n = np.rint(x / 1.5707963267948966)
    whole = n * _HALF_PI_FRONT  # exact
    yl, yu = sub(x, x, whole, whole)
    rest_l, rest_u = scale(n, _REST_LOWER, _REST_UPPER)
    yl, yu = sub(yl, yu, rest_l, rest_u)
    zl, zu = sqr(yl, yu)
    cl, cu, sl, su = 1.0, 1.0, 1.0, 1.0
    for k in range(_PAIRS_OF_TERMS, 0, -1):
        # From the last term inwards: 1 - y^2 / (2k - 1)(2k) times what is known, and 2k, 2k + 1 for the sine.
        pl, pu = mul(cl, cu, zl, zu)
        divisor = float((2 * k - 1) * (2 * k))
        cl, cu = sub(1.0, 1.0, down(pl / divisor), up(pu / divisor))
        pl, pu = mul(sl, su, zl, zu)
        divisor = float(2 * k * (2 * k + 1))
        sl, su = sub(1.0, 1.0, down(pl / divisor), up(pu / divisor))
    sl, su = mul(sl, su, yl, yu)
    cl, cu = down(cl - _COSINE_REMAINDER), up(cu + _COSINE_REMAINDER)
    sl, su = down(sl - _SINE_REMAINDER), up(su + _SINE_REMAINDER)
    quarter = int(n) % 4
    if quarter == 0:
        return cl, cu, sl, su
    if quarter == 1:
        return -su, -sl, cl, cu
    if quarter == 2:
        return -cu, -cl, -su, -sl
    return sl, su, -cu, -cl


@compiled
def trig_range(kind: int, xl: float, xu: float) -> tuple[float, float]:
    """Enclosure of cosine (`kind` 0) or sine (1) over [xl, xu], in rad."""
    # Not a number compares false.
    if not (xu - xl < 6.28 and xl > -_FARTHEST and xu < _FARTHEST):
        return -1.0, 1.0
    first, last = _cosine_and_sine(xl), _cosine_and_sine(xu)
    if kind == COSINE:
        lo, hi = min(first[0], last[0]), max(first[1], last[1])
    else:
        lo, hi = min(first[2], last[2]), max(first[3], last[3])
    shift = 0.0 if kind == COSINE else 0.5 * math.pi
    first_peak = int(np.ceil((xl - shift) / math.pi - _PEAK_ROOM))
    last_peak = int(np.floor((xu - shift) / math.pi + _PEAK_ROOM))
    for k in range(first_peak, last_peak + 1):
        if k % 2 == 0:
            hi = 1.0
        else:
            lo = -1.0
    return max(lo, -1.0), min(hi, 1.0)
