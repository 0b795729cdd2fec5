"""How far cosine and sine of (ratio x + offset) lie beside a line of any slope, over an interval of x.

Between two of its zeros the function f is concave, or convex where it is negative: f'' = -ratio^2 f. There
the ends bound it from one side, and any tangent from the other. Where a piece reaches over a zero by
rounding, its curvature has the wrong sign, by so little that taking a bound on that off costs nothing.
"""

import math

import numpy as np

from ...base.machine.jit import compiled
from ..interval import COSINE, mul, scale, sqr, sub, up
from .trig import trig_slope, trig_value

__all__ = ["beside_line"]

# Pieces that are looked at; an interval over more zeros than that is bounded by the function's range.
_MOST_PIECES = 64


@compiled
def beside_line(
    kind: int, ratio: float, offset: float, slope: float, a: float, b: float
) -> tuple[float, float]:
    """Enclosure of f(x) - slope x over [a, b]."""
    shift = 0.0 if kind == COSINE else 0.5 * math.pi
    # Peaks stand at multiples of pi behind the shift, zeros half way between them.
    first = np.floor((ratio * a + offset - shift) / math.pi + 0.5)
    last = np.floor((ratio * b + offset - shift) / math.pi + 0.5)
    if not last - first < _MOST_PIECES:
        lo, hi = trig_value(kind, ratio, offset, a, b)
        return sub(lo, hi, *scale(slope, a, b))
    least, most = np.inf, -np.inf
    p = a
    for piece in range(int(last - first) + 1):
        k = first + piece
        q = b if k == last else min(max((shift + (k + 0.5) * math.pi - offset) / ratio, p), b)
        if q > p or a == b:
            lo, hi = _beside_piece(kind, ratio, offset, slope, p, q, k, shift)
            least, most = min(least, lo), max(most, hi)
        p = q
    return least, most


@compiled
def _beside_piece(
    kind: int, ratio: float, offset: float, slope: float, p: float, q: float, k: float, shift: float
) -> tuple[float, float]:
    """`beside_line` over [p, q], which lies around peak number k but for rounding."""
    sign = 1.0 if k % 2.0 == 0.0 else -1.0
    lo, hi = trig_value(kind, ratio, offset, p, q)
    _, squared = sqr(ratio, ratio)
    # sign f is concave where it is positive.
    wrong = up(squared * max(0.0, -lo if sign > 0.0 else hi))
    _, width = sub(q, q, p, p)
    pl, _ = _beside_point(kind, ratio, offset, slope, p, sign)
    ql, _ = _beside_point(kind, ratio, offset, slope, q, sign)
    lost = up(up(wrong * up(width * width)) * 0.5)
    least, _ = sub(min(pl, ql), min(pl, ql), lost, lost)
    # Where the tangent has the line's slope: f = sign cos(y) at y from the peak.
    y = math.asin(min(max(-sign * slope / ratio, -1.0), 1.0))
    t = min(max((shift + k * math.pi + y - offset) / ratio, p), q)
    _, most = _beside_point(kind, ratio, offset, slope, t, sign)
    dl, du = trig_slope(kind, ratio, offset, t, t)
    dl, du = sub(dl, du, slope, slope)
    if sign < 0.0:
        dl, du = -du, -dl
    rise = -np.inf
    for end in (p, q):
        rise = max(rise, mul(dl, du, *sub(end, end, t, t))[1])
    most = up(up(most + rise) + lost)
    return (least, most) if sign > 0.0 else (-most, -least)


@compiled
def _beside_point(
    kind: int, ratio: float, offset: float, slope: float, x: float, sign: float
) -> tuple[float, float]:
    """Enclosure of sign (f(x) - slope x)."""
    lo, hi = trig_value(kind, ratio, offset, x, x)
    lo, hi = sub(lo, hi, *scale(slope, x, x))
    return (lo, hi) if sign > 0.0 else (-hi, -lo)
