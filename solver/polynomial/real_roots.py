"""The real roots of a polynomial in one unknown, isolated in exact arithmetic.

By Descartes' rule of signs in Bernstein form (Collins and Akritas 1976, Lane and Riesenfeld 1981): an
interval has as many roots as its Bernstein coefficients change sign, or an even number less. With no change
it has none, with one it has one; else it is halved. Where no root is multiple, this ends.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb, lcm

from .exact import enclose_fraction, simplest_between
from .whole import WholePolynomial, derivative, quotient, sign_at

__all__ = ["RealRoot", "real_roots"]

# An interval is narrow enough when its ends are next to the same float or at most this share of it apart.
_NARROW = Fraction(1, 2**53)
_TINY = Fraction(1, 2**900)


@dataclass(frozen=True)
class RealRoot:
    """A root, and where it is.

    Attributes:
        lower: the root lies at or above this.
        upper: the root lies at or below this; equal to `lower` where the root is this rational number.
        polynomial: with this root, which is its only one in [lower, upper].
    """

    lower: Fraction
    upper: Fraction
    polynomial: WholePolynomial

    @property
    def is_rational(self) -> bool:
        """Whether the root is known exactly."""
        return self.lower == self.upper


def real_roots(p: WholePolynomial, lower: Fraction, upper: Fraction) -> list[RealRoot]:
    """All real roots of p in [lower, upper], ascending, each once and about as narrow as floats are.

    Args:
        p: primitive and without multiple roots; see `without_multiple_roots`.
        lower: end of the interval.
        upper: end of the interval.
    """
    narrowed = [_narrowed(p, a, b) for a, b in _isolated(p, lower, upper)]
    exact = sorted({a for a, b in narrowed if a == b})
    rest = p
    for root in exact:
        rest = quotient(rest, (-root.numerator, root.denominator))
    found = [RealRoot(a, a, (-a.numerator, a.denominator)) for a in exact]
    found += [RealRoot(a, b, rest) for a, b in narrowed if a != b]
    return sorted(found, key=lambda root: (root.lower, root.upper))


def _isolated(p: WholePolynomial, lower: Fraction, upper: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Intervals with one root each: a point, or open ones."""
    if len(p) <= 1:
        return
    ends = {lower, upper}
    yield from ((x, x) for x in ends if sign_at(p, x) == 0)
    stack = [(lower, upper, _bernstein(p, lower, upper))] if lower < upper else []
    while stack:
        a, b, coefficients = stack.pop()
        changes = _sign_changes(coefficients)
        if changes == 1:
            yield a, b
        elif changes > 1:
            middle = (a + b) / 2
            left, right = _halves(coefficients)
            if right[0] == 0:
                yield middle, middle
            stack += [(a, middle, left), (middle, b, right)]


def _bernstein(p: WholePolynomial, a: Fraction, b: Fraction) -> list[int]:
    """A positive multiple of the Bernstein coefficients of p over [a, b], in whole numbers."""
    d = len(p) - 1
    shifted = [Fraction(c) for c in p]
    for i in range(d):  # Taylor's coefficients about a, by Horner's scheme
        for k in range(d - 1, i - 1, -1):
            shifted[k] += a * shifted[k + 1]
    width = b - a
    scaled = [c * width**k / comb(d, k) for k, c in enumerate(shifted)]
    values = [sum((comb(i, k) * scaled[k] for k in range(i + 1)), Fraction(0)) for i in range(d + 1)]
    below = lcm(*(v.denominator for v in values))
    return [v.numerator * (below // v.denominator) for v in values]


def _halves(coefficients: list[int]) -> tuple[list[int], list[int]]:
    """The same over both halves of the interval, by de Casteljau's scheme; each a multiple of its own."""
    d = len(coefficients) - 1
    row = coefficients
    left, right = [], []
    for level in range(d + 1):
        # Sums stand for means: row number k is 2^k times as large as it should be.
        left.append(row[0] << (d - level))
        right.append(row[-1] << (d - level))
        row = [x + y for x, y in pairwise(row)]
    return left, right[::-1]


def _sign_changes(values: list[int]) -> int:
    signs = [v > 0 for v in values if v]
    return sum(a != b for a, b in pairwise(signs))


def _narrowed(p: WholePolynomial, a: Fraction, b: Fraction) -> tuple[Fraction, Fraction]:
    """A narrow interval around the only root in ]a, b[, or the root itself where it is a simple fraction."""
    if a == b:
        return a, b
    # Right of a, which may be a root too, p has the sign of its slope there.
    left = sign_at(p, a) or sign_at(derivative(p), a)
    while not _is_narrow(a, b):
        middle = _rounded_middle(a, b)
        sign = sign_at(p, middle)
        if sign == 0:
            return middle, middle
        a, b = (middle, b) if sign == left else (a, middle)
    guess = simplest_between(a, b)
    return (guess, guess) if a < guess < b and sign_at(p, guess) == 0 else (a, b)


def _is_narrow(a: Fraction, b: Fraction) -> bool:
    return b - a <= max(_NARROW * max(abs(a), abs(b)), _TINY)


def _rounded_middle(a: Fraction, b: Fraction) -> Fraction:
    """A point near the middle, a float where one lies between, so that numbers stay short."""
    middle = (a + b) / 2
    near = Fraction(enclose_fraction(middle)[0])
    return near if a < near < b else middle
