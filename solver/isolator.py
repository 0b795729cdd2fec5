"""What branch and prune does with a box of a polynomial system, and the record of what was found."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from .certifier import Certifier, Interval, hull, is_within
from .contract_native import CERTIFIED, EMPTY, contract_native, smear, square_inverse
from .exact_system import evaluate, independent, simplest_between, substitute
from .expression import ExactPolynomial
from .native import enclose_fraction
from .search import Outcome

__all__ = ["Isolator", "SolutionBox"]

Array = NDArray[np.float64]

_SLICES = 8  # by the counts of `benchmarks/systems.py`: fewer prune less, more cost more than they save
_SMALL = 0.1  # share of its place at which a box is worth a look for the one solution it may hold
_NARROWEST = 1e-13  # the same for boxes that floats hardly split


@dataclass(frozen=True, eq=False)
class SolutionBox:
    """A box of the result.

    Attributes:
        lower: (n,)
        upper: (n,)
        certified: True where a true solution is proved to lie in it (exactly one, for square systems).
    """

    lower: Array
    upper: Array
    certified: bool

    @property
    def middle(self) -> Array:
        """Middle (n,) of the box."""
        return 0.5 * (self.lower + self.upper)

    @property
    def radius(self) -> float:
        """A number such that every point of the box is within it of the middle, in every variable."""
        middle = self.middle
        return float(np.nextafter(np.maximum(self.upper - middle, middle - self.lower).max(), np.inf))


@dataclass(frozen=True, eq=False)
class _Known:
    """A solution that is accounted for, in the box that was asked for or not.

    Attributes:
        region: it is the only one in here.
        place: it lies in here.
    """

    region: Interval
    place: Interval


class _Listed:
    """The solution boxes of the result, stacked."""

    def __init__(self, n: int):
        self._lower, self._upper, self._middle = np.zeros((0, n)), np.zeros((0, n)), np.zeros((0, n))
        self._radius = np.zeros((0, 1))

    def append(self, box: SolutionBox) -> None:
        self._lower, self._upper = np.vstack([self._lower, box.lower]), np.vstack([self._upper, box.upper])
        self._middle = np.vstack([self._middle, box.middle])
        self._radius = np.vstack([self._radius, [[box.radius]]])

    def is_apart(self, box: SolutionBox) -> bool:
        """Whether neither the box nor any of those listed reaches within the radius of the other."""
        low, high = box.middle - box.radius, box.middle + box.radius
        out_of_its_reach = np.any((self._upper < low) | (self._lower > high), axis=1)
        low, high = self._middle - self._radius, self._middle + self._radius
        out_of_theirs = np.any((box.upper < low) | (box.lower > high), axis=1)
        return bool(np.all(out_of_its_reach & out_of_theirs))


class Isolator:
    """What is done with a box of m equations, and what is known of their solutions."""

    def __init__(
        self,
        equations: Sequence[ExactPolynomial],
        asked: Sequence[tuple[Fraction, Fraction]],
        root: Interval,
        sigma: float,
    ):
        self.root = root  # `asked`, rounded outward
        self.deferred: list[Interval] = []
        self._asked = asked
        self._equations = equations
        self._sigma = sigma
        self._certifier = Certifier(equations, len(asked))
        self._m, self._n = len(equations), len(asked)
        self._known: list[_Known] = []
        self._regions = np.zeros((0, self._n)), np.zeros((0, self._n))  # of `_known`, stacked
        self._listed = _Listed(self._n)

    def process(self, box: Interval) -> Outcome[Interval, SolutionBox]:
        """Contracts a box; certifies, splits, or puts it aside where a multiple solution is in the way."""
        return self._process(box, may_defer=True)

    def process_deferred(self, box: Interval) -> Outcome[Interval, SolutionBox]:
        """The same for boxes that were put aside."""
        return self._process(box, may_defer=False)

    def _process(self, box: Interval, *, may_defer: bool) -> Outcome[Interval, SolutionBox]:
        lower, upper = box[0].copy(), box[1].copy()
        if self._is_solved(lower, upper):
            return Outcome()
        known = self._certifier
        status = contract_native(known.system, known.program, lower, upper, known.workspace, _SLICES)
        if status == EMPTY or self._is_solved(lower, upper):
            return Outcome()
        if self._m < self._n:
            return self._cover(lower, upper)
        if status == CERTIFIED:
            return self._settle((lower, upper))
        is_narrow = self._is_narrow(lower, upper)
        near = self._solution_near(lower, upper)
        if near is not None:
            if self._m == self._n and not self._is_solved(near, near):
                around = self._certifier.widest_unique(near, self._scale(near))
                if around is not None and is_within((lower, upper), around):
                    return self._settle(around)
            if may_defer and not is_narrow and self._is_singular(near):
                self.deferred.append((lower, upper))
                return Outcome()
        if is_narrow:
            return Outcome(undecided=(lower, upper))
        return Outcome(children=self._split(lower, upper))

    def _is_solved(self, lower: Array, upper: Array) -> bool:
        """Whether the box lies in one whose only solution is known."""
        low, high = self._regions
        return bool(np.any(np.all((lower >= low) & (upper <= high), axis=1)))

    def _is_narrow(self, lower: Array, upper: Array) -> bool:
        least = _NARROWEST * np.maximum(np.abs(lower), np.abs(upper))
        return bool(np.all(upper - lower <= np.maximum(self._sigma, least)))

    def _solution_near(self, lower: Array, upper: Array) -> Array | None:
        """An approximate solution in or next to a small box (a guess, no proof)."""
        if np.any(upper - lower > _SMALL * (1.0 + np.abs(upper))):
            return None
        room = np.maximum(upper - lower, 1e-9 * (1.0 + np.abs(upper)))
        return self._certifier.approximate(0.5 * (lower + upper), (lower - room, upper + room))

    def _is_singular(self, x: Array) -> bool:
        """Whether the Jacobian seems to lose rank (a guess, no proof)."""
        J = self._certifier.middle_slopes(x)[1]
        if not np.isfinite(J).all():
            return False
        values = np.linalg.svd(J, compute_uv=False)
        return bool(values[-1] <= 1e-6 * values[0])

    def _scale(self, x: Array) -> Array:
        """Radii (n,) up to which a box around x is tried; the box asked for may be a good deal thinner."""
        size = 1.0 + np.abs(x)
        return np.clip(self.root[1] - self.root[0], 1e-3 * size, size)

    def _cover(self, lower: Array, upper: Array) -> Outcome[Interval, SolutionBox]:
        """Fewer equations than unknowns: small boxes make up the result."""
        if not self._is_narrow(lower, upper):
            return Outcome(children=self._split(lower, upper))
        return Outcome([SolutionBox(lower, upper, self._holds_point(lower, upper))])

    def _holds_point(self, lower: Array, upper: Array) -> bool:
        """Whether a solution is proved in the box: with all but m variables held at a point's values."""
        x = self._certifier.approximate(0.5 * (lower + upper))
        if x is None:
            return False
        x = np.clip(x, lower, upper)
        k = self._m
        rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
        J = self._certifier.middle_slopes(x)[1]
        if not square_inverse(J, upper - lower, rows, columns, np.empty((k, k))):
            return False
        low, high = x.copy(), x.copy()
        room = 1e-10 * (1.0 + np.abs(x[columns]))
        low[columns] = np.maximum(lower[columns], x[columns] - room)
        high[columns] = np.minimum(upper[columns], x[columns] + room)
        # The root is rounded outward, so a point on its rim may lie outside of what was asked for.
        return self._certifier.test(x, (low, high))[0] and self._lies_inside((low, high))

    def _settle(self, region: Interval) -> Outcome[Interval, SolutionBox]:
        """Accounts for the only solution of a region; what else was in the box at hand is done with."""
        place = self._certifier.refine(region, self._scale(0.5 * (region[0] + region[1])))
        same = self._is_known(place, region)
        if same:
            return Outcome()
        inside: bool | None = None  # where it can't be told from a solution that is known
        if same is not None:
            middle = 0.5 * (place[0] + place[1])
            wide = self._certifier.widest_unique(middle, self._scale(middle))
            # The solution of `wide` is that of `region` if it is bound to lie in both.
            if wide is None or not (is_within(place, wide) or is_within(wide, region)):
                wide = region
            inside, place = self._decide_inside(place, region)
            self._known.append(_Known(wide, place))
            self._regions = (
                np.vstack([self._regions[0], wide[0]]),
                np.vstack([self._regions[1], wide[1]]),
            )
        if inside is False:
            return Outcome()
        clipped = np.maximum(place[0], self.root[0]), np.minimum(place[1], self.root[1])
        found = SolutionBox(*clipped, certified=True)
        if inside is None or not self._listed.is_apart(found):
            return Outcome(undecided=clipped)
        self._listed.append(found)
        return Outcome([found])

    def _is_known(self, place: Interval, region: Interval) -> bool | None:
        """Whether the only solution of `region`, lying at `place`, is known; None if it can't be told."""
        for known in self._known:
            if is_within(place, known.region) or is_within(known.place, region):
                return True
            if np.any(place[1] < known.place[0]) or np.any(place[0] > known.place[1]):
                continue
            both = hull(place, known.place)
            if self._certifier.test(0.5 * (both[0] + both[1]), both)[0]:
                return True
            return None
        return False

    def _lies_inside(self, place: Interval, but: Collection[int] = ()) -> bool:
        """Whether a box lies in the box asked for, in all variables but some."""
        return all(
            k in but or (self._asked[k][0] <= Fraction(a) and Fraction(b) <= self._asked[k][1])
            for k, (a, b) in enumerate(zip(*(end.tolist() for end in place), strict=True))
        )

    def _lies_outside(self, place: Interval) -> bool:
        return any(
            high < Fraction(a) or Fraction(b) < low
            for (low, high), a, b in zip(self._asked, place[0].tolist(), place[1].tolist(), strict=True)
        )

    def _decide_inside(self, place: Interval, region: Interval) -> tuple[bool | None, Interval]:
        """Whether a region's only solution, at `place`, is in the box asked for; None if that is open.

        On the rim no enclosure can tell. What can: the solution is rational with small denominators, or
        it solves the system that is left with the variables in question exactly on the rim.
        """
        if self._lies_inside(place):
            return True, place
        if self._lies_outside(place):
            return False, place
        ends = [(Fraction(a), Fraction(b)) for a, b in zip(*(end.tolist() for end in place), strict=True)]
        guess = [simplest_between(a, b) for a, b in ends]
        if all(evaluate(e, guess) == 0 for e in self._equations):
            inside = all(low <= v <= high for (low, high), v in zip(self._asked, guess, strict=True))
            return inside, _enclose_points(guess)
        rim = {}
        for k, ((low, high), (a, b)) in enumerate(zip(self._asked, ends, strict=True)):
            if a < low and high < b:
                return None, place
            if a < low:
                rim[k] = low
            elif high < b:
                rim[k] = high
        rest = independent([substitute(e, rim) for e in self._equations])
        free = [k for k in range(self._n) if k not in rim]
        if len(rest) != len(free) or not free:
            return None, place
        certifier = Certifier(rest, len(free))
        middle = 0.5 * (place[0] + place[1])
        scale = self._scale(middle)[free]
        around = certifier.widest_unique(middle[free], scale)
        if around is None:
            return None, place
        on_rim = _enclose_points([rim.get(k, Fraction(0)) for k in range(self._n)])
        on_rim[0][free], on_rim[1][free] = certifier.refine(around, scale)
        # There is a solution here; if it lies in the region, it is the one in question.
        if is_within(on_rim, region) and self._lies_inside(on_rim, but=rim):
            return True, on_rim
        return None, place

    def _split(self, lower: Array, upper: Array) -> tuple[Interval, Interval]:
        """Two halves, cut across the variable that blurs the equations most."""
        width = upper - lower
        if self._m < self._n:
            score = width
        else:
            score = smear(self._certifier.system, lower, upper, self._certifier.workspace)
        size = np.maximum(np.abs(lower), np.abs(upper))
        splits = width > np.maximum(_NARROWEST * size, min(self._sigma, 1e-9))
        score = np.where(splits, np.nan_to_num(score, nan=np.inf, posinf=np.inf), -1.0)
        k = int(np.argmax(score))
        at = lower[k] + 0.4871 * width[k]  # off the middle: solutions like to sit on symmetric places
        left, right = upper.copy(), lower.copy()
        left[k] = right[k] = at
        return (lower, left), (right, upper)


def _enclose_points(values: Sequence[Fraction]) -> Interval:
    ends = [enclose_fraction(v) for v in values]
    return np.array([lo for lo, _ in ends]), np.array([hi for _, hi in ends])
