"""The closed box that solutions are asked for in, with exact ends, and on which side of its rim they lie."""

from collections.abc import Collection, Sequence
from fractions import Fraction

import numpy as np

from ...base.numeric.arrays import Array
from ..interval import Interval, is_within
from ..polynomial import (
    ExactPolynomial,
    enclose_fraction,
    evaluate,
    independent,
    simplest_between,
    substitute,
)
from .interval_newton import Certifier

__all__ = ["ClosedBox", "Ends", "enclosure"]

Ends = Sequence[tuple[Fraction, Fraction]]


def enclosure(ends: Ends) -> Interval:
    """The box (n,), (n,) with its ends rounded outward."""
    lower = np.array([enclose_fraction(low)[0] for low, _ in ends], dtype=np.float64)
    upper = np.array([enclose_fraction(high)[1] for _, high in ends], dtype=np.float64)
    return lower, upper


class ClosedBox:
    """A box that solutions of a system are asked for in.

    Args:
        equations: of the system.
        ends: lower and upper end of each unknown.

    Attributes:
        rounded: the box, rounded outward.
    """

    def __init__(self, equations: Sequence[ExactPolynomial], ends: Ends):
        self._equations, self._ends = equations, ends
        self.rounded = enclosure(ends)

    def scale(self, x: Array) -> Array:
        """Radii (n,) up to which a box around x is tried; the one asked for may be a good deal thinner."""
        size = 1.0 + np.abs(x)
        return np.clip(self.rounded[1] - self.rounded[0], 1e-3 * size, size)

    def clip(self, place: Interval) -> Interval:
        """The part of a box that lies in this one, rounded outward."""
        return np.maximum(place[0], self.rounded[0]), np.minimum(place[1], self.rounded[1])

    def holds(self, place: Interval, but: Collection[int] = ()) -> bool:
        """Whether a box lies in this one, in all variables but some."""
        return all(
            k in but or (low <= a and b <= high)
            for k, ((low, high), (a, b)) in enumerate(zip(self._ends, _exact(place), strict=True))
        )

    def decide(self, place: Interval, region: Interval) -> tuple[bool | None, Interval]:
        """Whether a region's only solution, at `place`, is in this box, None if that is open; and its place.

        On the rim no enclosure can tell. What can: the solution is rational with small denominators, or
        it solves the system that is left with the variables in question exactly on the rim.
        """
        if self.holds(place):
            return True, place
        ends = _exact(place)
        if any(high < a or b < low for (low, high), (a, b) in zip(self._ends, ends, strict=True)):
            return False, place
        guess = [simplest_between(a, b) for a, b in ends]
        if all(evaluate(e, guess) == 0 for e in self._equations):
            inside = all(low <= v <= high for (low, high), v in zip(self._ends, guess, strict=True))
            return inside, enclosure([(v, v) for v in guess])
        on_rim = self._solution_on_rim(place, ends)
        # If there is one in the region, it is the one in question.
        if on_rim is not None and is_within(on_rim, region):
            return True, on_rim
        return None, place

    def _solution_on_rim(self, place: Interval, ends: Ends) -> Interval | None:
        """Where the solution exactly on those parts of the rim lies that `place` reaches over, if any."""
        rim = {}
        for k, ((low, high), (a, b)) in enumerate(zip(self._ends, ends, strict=True)):
            if a < low and high < b:
                return None
            if a < low:
                rim[k] = low
            elif high < b:
                rim[k] = high
        rest = independent([substitute(e, rim) for e in self._equations])
        free = [k for k in range(len(ends)) if k not in rim]
        if len(rest) != len(free) or not free:
            return None
        certifier = Certifier(rest, len(free))
        middle = 0.5 * (place[0] + place[1])
        scale = self.scale(middle)[free]
        around = certifier.widest_unique(middle[free], scale)
        if around is None:
            return None
        values = [rim.get(k, Fraction(0)) for k in range(len(ends))]
        on_rim = enclosure([(v, v) for v in values])
        on_rim[0][free], on_rim[1][free] = certifier.refine(around, scale)
        return on_rim if self.holds(on_rim, but=rim) else None


def _exact(place: Interval) -> Ends:
    lower, upper = (end.tolist() for end in place)
    return [(Fraction(a), Fraction(b)) for a, b in zip(lower, upper, strict=True)]
