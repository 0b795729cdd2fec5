"""Joint angles as (cosine, sine) pairs of variables, with their sums and multiples.

An angle is free, and its pair lies on the circle; or it is ratio x + offset of a variable x, the angle of a
joint in rad, and its pair are the cosine and the sine of that, whatever the ratio.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..interval import COSINE, SINE
from ..polynomial import Polynomial, SystemBuilder

__all__ = ["LIMIT_ROOM", "Angle", "Turn", "angle_variable", "multiple", "negated", "sum_of", "turned"]

# Closed limits are widened by this much (rad, m, or patch parameter), so that a configuration that stands
# exactly at a limit can still be certified; far below anything a mechanism could tell apart.
LIMIT_ROOM = 1e-9
_CHORD_ROOM = 1e-12


class Turn(NamedTuple):
    """The angle ratio x + offset.

    Attributes:
        x: a variable, in rad.
        ratio: any number.
        offset: in rad.
    """

    x: Polynomial
    ratio: float
    offset: float


@dataclass(frozen=True)
class Angle:
    """An angle known through its cosine and sine.

    Attributes:
        cos: polynomial for the cosine, of degree at most 1.
        sin: polynomial for the sine, of degree at most 1.
        lower: lower limit in rad.
        upper: upper limit in rad.
        turn: what it is by a variable; None for a free angle, and for sums with one.
    """

    cos: Polynomial
    sin: Polynomial
    lower: float
    upper: float
    turn: Turn | None = None


def angle_variable(builder: SystemBuilder, name: str, lower: float, upper: float) -> Angle:
    """A free angle within limits: c^2 + s^2 = 1, boxed, and cut to its arc by a chord."""
    lower, upper = lower - LIMIT_ROOM, upper + LIMIT_ROOM
    (cl, cu), (sl, su) = _range(lower, upper)
    c = builder.variable(f"cos {name}", cl, cu)
    s = builder.variable(f"sin {name}", sl, su)
    builder.equate(c * c + s * s - 1.0)
    angle = Angle(c, s, lower, upper)
    _add_chord(builder, angle)
    return angle


def turned(builder: SystemBuilder, name: str, turn: Turn) -> Angle:
    """The angle of a turn: its cosine and sine are functions of the variable, and still lie on the circle."""
    x, ratio, offset = turn
    if ratio == 0.0:
        c, s = (Polynomial.constant(float(f(offset))) for f in (np.cos, np.sin))
        return Angle(c, s, offset, offset, turn)
    (i,) = x.variables
    lower, upper = sorted((ratio * builder.lower[i] + offset, ratio * builder.upper[i] + offset))
    c = builder.trig(f"cos {name}", x, COSINE, ratio, offset)
    s = builder.trig(f"sin {name}", x, SINE, ratio, offset)
    angle = Angle(c, s, lower, upper, turn)
    builder.imply(c * c + s * s - 1.0)
    _add_chord(builder, angle)
    return angle


def sum_of(builder: SystemBuilder, name: str, a: Angle, b: Angle) -> Angle:
    """The angle a + b: turns of one variable add up to a turn, anything else obeys the addition theorems."""
    if a.turn is None or b.turn is None or a.turn.x.variables != b.turn.x.variables:
        return _added(builder, name, a, b)
    # Of floats, so the sum of two ratios is rounded, as all coefficients are.
    both = Turn(a.turn.x, a.turn.ratio + b.turn.ratio, a.turn.offset + b.turn.offset)
    return turned(builder, name, both)


def _added(builder: SystemBuilder, name: str, a: Angle, b: Angle) -> Angle:
    """The angle a + b by the addition theorems."""
    lower, upper = a.lower + b.lower, a.upper + b.upper
    (cl, cu), (sl, su) = _range(lower, upper)
    c = builder.define(f"cos {name}", a.cos * b.cos - a.sin * b.sin, cl, cu)
    s = builder.define(f"sin {name}", a.sin * b.cos + a.cos * b.sin, sl, su)
    out = Angle(c, s, lower, upper)
    builder.imply(c * c + s * s - 1.0)
    # The difference b = (a + b) - a closes the triangle.
    builder.imply(c * a.cos + s * a.sin - b.cos)
    builder.imply(s * a.cos - c * a.sin - b.sin)
    _add_chord(builder, out)
    return out


def multiple(builder: SystemBuilder, name: str, a: Angle, n: int, offset: float) -> Angle:
    """The angle n a + offset for a whole number n other than zero."""
    out = _whole_multiple(builder, name, {1: a}, abs(n))
    if n < 0:
        out = negated(out)
    if offset == 0.0:
        return out
    co, so = float(np.cos(offset)), float(np.sin(offset))
    c, s = out.cos * co - out.sin * so, out.sin * co + out.cos * so
    return Angle(c, s, out.lower + offset, out.upper + offset)


def _whole_multiple(builder: SystemBuilder, name: str, known: dict[int, Angle], n: int) -> Angle:
    """The n-fold of `known[1]` from its halves, which takes two sums for each doubling at most."""
    if n not in known:
        halves = [_whole_multiple(builder, name, known, half) for half in (n // 2, n - n // 2)]
        known[n] = sum_of(builder, f"{name} x{n}", *halves)
    return known[n]


def negated(a: Angle) -> Angle:
    """The angle -a."""
    turn = None if a.turn is None else Turn(a.turn.x, -a.turn.ratio, -a.turn.offset)
    return Angle(a.cos, -a.sin, -a.upper, -a.lower, turn)


def _range(lower: float, upper: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Enclosures of cosine and sine over [lower, upper], a little outward, and so also beyond 1."""
    out = []
    for f, shift in ((np.cos, 0.0), (np.sin, 0.5 * np.pi)):
        ends = (float(f(lower)), float(f(upper)))
        # Peaks of cos(x - shift) lie at multiples of pi, counted from the shift.
        first = np.ceil((lower - shift - 1e-12) / np.pi)
        last = np.floor((upper - shift + 1e-12) / np.pi)
        peaks = [1.0 if k % 2 == 0 else -1.0 for k in np.arange(first, min(last, first + 1) + 1)]
        values = [*ends, *peaks]
        out.append((min(values) - LIMIT_ROOM, max(values) + LIMIT_ROOM))
    return out[0], out[1]


def _add_chord(builder: SystemBuilder, angle: Angle) -> None:
    """Cuts the circle to the arc within the limits: cos(angle - middle) >= cos(half width)."""
    half = 0.5 * (angle.upper - angle.lower)
    if half >= np.pi:
        return
    middle = 0.5 * (angle.upper + angle.lower)
    # Room for the width of a certified box; in a narrow arc the chord hardly cuts, and the intervals do.
    bound = float(np.cos(half)) - _CHORD_ROOM
    builder.at_least_zero(angle.cos * float(np.cos(middle)) + angle.sin * float(np.sin(middle)) - bound)
