"""Functions x_k = cosine or sine of (ratio x_i + offset): what they say of their variables, and lines beside.

Arguments are worked out exactly, values in whole numbers (`cosine.py`). Floats only guess where something is,
and what is concluded from a guess is then shown, so that a wrong one concludes less.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from .box import Box
from .cosine import ERROR, ONE, PI, cosine_and_sine, to_units

__all__ = ["TrigFunction"]

# Angles beyond this (rad) count as unknown.
_FARTHEST = 1000
# A peak counts as within an interval that ends so many units before it; it is placed much better than that.
_ROOM = 1 << 20
# How far from a guess a cut is tried, nearest first.
_STEPS_BACK = (1e-12, 1e-9, 1e-6)
# Pieces between zeros that are looked at, at most.
_MOST_PIECES = 64


@dataclass(frozen=True)
class TrigFunction:
    """One function.

    Attributes:
        k: column of its value.
        i: column of its variable.
        is_sine: or else it is a cosine.
        ratio: above zero.
        offset: in rad.
    """

    k: int
    i: int
    is_sine: bool
    ratio: float
    offset: float

    def narrow(self, box: Box) -> None:
        """Cuts both columns of a box to what the function says of them."""
        a, b = float(box.lower[self.i]), float(box.upper[self.i])
        if not a <= b:
            return
        low, high = self.range_over(a, b)
        low, high = max(low, float(box.lower[self.k])), min(high, float(box.upper[self.k]))
        box.lower[self.k], box.upper[self.k] = low, high
        if low <= high:
            box.lower[self.i], box.upper[self.i] = self.inputs(low, high, a, b)

    def range_over(self, a: float, b: float) -> tuple[float, float]:
        """An enclosure of the values over [a, b]."""
        first, last = self._angle(a), self._angle(b) + 1
        if max(-first, last) > _FARTHEST * ONE or last - first > 2 * PI:
            return -1.0, 1.0
        ends = self._value(first), self._value(last)
        low, high = _below(min(ends) - ERROR), _above(max(ends) + ERROR)
        shift = PI // 2 if self.is_sine else 0
        for peak in range(-((shift + _ROOM - first) // PI), (last - shift + _ROOM) // PI + 1):
            low, high = (-1.0, high) if peak % 2 else (low, 1.0)
        return max(low, -1.0), min(high, 1.0)

    def inputs(self, low: float, high: float, a: float, b: float) -> tuple[float, float]:
        """The part of [a, b] where the value may lie in [low, high]; empty with its ends exchanged."""
        for at_end in (False, True):
            least, most = self.range_over(b, b) if at_end else self.range_over(a, a)
            if most >= low and least <= high:
                continue
            level = low if most < low else high
            if not -1.0 <= level <= 1.0 or self._misses(low, high, a, b):
                return math.inf, -math.inf
            reached = [x for x in self._where(level, b if at_end else a) if a < x < b]
            for back in _STEPS_BACK if reached else ():
                cut = max(reached) + back if at_end else min(reached) - back
                if a < cut < b and self._misses(low, high, *((cut, b) if at_end else (a, cut))):
                    a, b = (a, cut) if at_end else (cut, b)
                    break
        return a, b

    def beside_line(self, slope: float, a: float, b: float) -> tuple[float, float]:
        """Bounds over [a, b] of f(x) - slope x, piece by piece between the zeros of f."""
        if not a <= b or max(abs(self._angle(a)), abs(self._angle(b))) > _FARTHEST * ONE:
            return -math.inf, math.inf
        shift = 0.5 * math.pi if self.is_sine else 0.0
        first, last = (math.floor((self.ratio * x + self.offset - shift) / math.pi + 0.5) for x in (a, b))
        if last - first >= _MOST_PIECES:
            return -math.inf, math.inf
        zeros = [self._at(shift + (k + 0.5) * math.pi) for k in range(first, last)]
        ends = [a, *sorted(x for x in zeros if a < x < b), b]
        bounds = [self._beside_piece(slope, p, q) for p, q in pairwise(ends)]
        return _below(min(low for low, _ in bounds)), _above(max(high for _, high in bounds))

    def _beside_piece(self, slope: float, p: float, q: float) -> tuple[int, int]:
        """`beside_line` in units over [p, q], where f has one sign but for rounding."""
        least, most = self.range_over(p, q)
        sign = 1 if least + most >= 0.0 else -1  # of f, which is concave where it is positive
        # f'' = -ratio^2 f: where it has the other sign, it is at most so large.
        wrong = Fraction(max(0.0, -least if sign > 0 else most)) * Fraction(self.ratio) ** 2
        lost = to_units(wrong * (Fraction(q) - Fraction(p)) ** 2 / 2) + 1
        # A concave function lies above the smaller of its values at the ends,
        low = min(sign * self._beside(slope, x) for x in (p, q)) - ERROR - 1 - lost
        # and below any tangent, of which the one is best that has the line's slope.
        t = self._touch(slope, p, q, sign)
        rise = (
            Fraction(sign * (self._slope(t) + e), ONE) - sign * Fraction(slope) for e in self._slope_errors
        )
        rises = [to_units(d * (Fraction(x) - Fraction(t))) + 1 for d in rise for x in (p, q)]
        high = sign * self._beside(slope, t) + ERROR + 1 + max(rises) + lost
        return (low, high) if sign > 0 else (-high, -low)

    def _touch(self, slope: float, p: float, q: float, sign: int) -> float:
        """About where in [p, q] the function has a slope, or comes nearest to it."""
        shift = 0.5 * math.pi if self.is_sine else 0.0
        middle = self.ratio * 0.5 * (p + q) + self.offset
        peak = shift + math.pi * round((middle - shift) / math.pi)
        lean = min(max(-sign * slope / self.ratio, -1.0), 1.0)
        return min(max(self._at(peak + math.asin(lean)), p), q)

    def _beside(self, slope: float, x: float) -> int:
        """f(x) - slope x in units, to within `ERROR` and one."""
        return self._value(self._angle(x)) - to_units(Fraction(slope) * Fraction(x))

    def _slope(self, x: float) -> int:
        """f'(x) in units, to within each of `_slope_errors`."""
        cosine, sine = cosine_and_sine(self._angle(x))
        return to_units(Fraction(self.ratio) * Fraction(cosine if self.is_sine else -sine, ONE))

    @property
    def _slope_errors(self) -> tuple[int, int]:
        error = to_units(Fraction(self.ratio) * Fraction(ERROR, ONE)) + 2
        return -error, error

    def _misses(self, low: float, high: float, a: float, b: float) -> bool:
        least, most = self.range_over(a, b)
        return most < low or least > high

    def _where(self, level: float, near: float) -> list[float]:
        """About where the function has a value, in the turns around a place."""
        shift = 0.5 * math.pi if self.is_sine else 0.0
        turn = round((self.ratio * near + self.offset - shift) / (2.0 * math.pi))
        base = math.acos(level)
        return [
            self._at(shift + angle + 2.0 * math.pi * (turn + n))
            for angle in (base, -base)
            for n in (-1, 0, 1)
        ]

    def _at(self, angle: float) -> float:
        """About where the argument is an angle."""
        return (angle - self.offset) / self.ratio

    def _angle(self, x: float) -> int:
        """The argument at x in units, rounded down from its exact value."""
        return to_units(Fraction(self.ratio) * Fraction(x) + Fraction(self.offset))

    def _value(self, angle: int) -> int:
        """The function where its argument is an angle, in units, to within `ERROR`."""
        return cosine_and_sine(angle)[self.is_sine]


def _below(units: int) -> float:
    """A float below so many units."""
    try:
        return math.nextafter(units / ONE, -math.inf)
    except OverflowError:
        return -math.inf


def _above(units: int) -> float:
    """A float above so many units."""
    return -_below(-units)
