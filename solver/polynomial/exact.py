"""Polynomials with rational coefficients, worked on exactly: products, values, substitution, dependence."""

import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from math import floor, lcm
from typing import Self, TypeAlias, TypeVar

__all__ = [
    "ExactPolynomial",
    "Powers",
    "WholeForm",
    "collected",
    "enclose_fraction",
    "evaluate",
    "independent",
    "normalised",
    "simplest_between",
    "substitute",
]


# A monomial as (variable, exponent) with exponents >= 1, variables ascending; x_2^2 x_5 is ((2, 2), (5, 1)).
Powers: TypeAlias = tuple[tuple[int, int], ...]
M = TypeVar("M")


def collected(terms: Iterable[tuple[M, Fraction]]) -> dict[M, Fraction]:
    """The sum of terms by monomial, in the order in which monomials first occur, cancelled ones included."""
    out: dict[M, Fraction] = {}
    for monomial, coefficient in terms:
        out[monomial] = out.get(monomial, Fraction(0)) + coefficient
    return out


class ExactPolynomial(dict[Powers, Fraction]):
    """Rational coefficients by monomial. A plain dict of that form serves wherever one is only read."""

    @classmethod
    def constant(cls, value: Fraction) -> Self:
        """The constant polynomial."""
        return cls({(): value})

    @classmethod
    def variable(cls, index: int) -> Self:
        """The variable number `index`."""
        return cls({((index, 1),): Fraction(1)})

    @property
    def degree(self) -> int:
        """Total degree; 0 for constants."""
        return max((sum(e for _, e in m) for m in self), default=0)

    def __mul__(self, other: Mapping[Powers, Fraction]) -> Self:
        """The product, with the terms that cancel in it as zeros."""
        pairs = ((_product(m, n), c * d) for m, c in self.items() for n, d in other.items())
        return type(self)(collected(pairs))

    def add(self, other: Mapping[Powers, Fraction], factor: Fraction | int = 1) -> None:
        """Adds a multiple of another polynomial in place; terms that cancel are dropped."""
        for monomial, c in other.items():
            value = self.pop(monomial, Fraction(0)) + factor * c
            if value:
                self[monomial] = value

    def without_zeros(self) -> Self:
        """The terms that are not zero."""
        return type(self)({m: c for m, c in self.items() if c})


def _product(m: Powers, n: Powers) -> Powers:
    exponents = dict(m)
    for variable, e in n:
        exponents[variable] = exponents.get(variable, 0) + e
    return tuple(sorted(exponents.items()))


def evaluate(polynomial: Mapping[Powers, Fraction], x: Sequence[Fraction]) -> Fraction:
    """The exact value at x (n,)."""
    return WholeForm(polynomial).value(x)


def enclose_fraction(value: Fraction) -> tuple[float, float]:
    """The two floats next to an exact number, equal where it is a float; infinite beyond all floats."""
    try:
        near = float(value)
    except OverflowError:
        largest = sys.float_info.max
        return (largest, math.inf) if value > 0 else (-math.inf, -largest)
    exact = Fraction(near)
    if exact == value:
        return near, near
    return (
        (near, math.nextafter(near, math.inf)) if exact < value else (math.nextafter(near, -math.inf), near)
    )


class WholeForm:
    """A polynomial with its denominators cleared once, so that values at many points are soon found."""

    def __init__(self, polynomial: Mapping[Powers, Fraction]):
        self._below = lcm(*(c.denominator for c in polynomial.values()))
        self._degree = max((sum(e for _, e in m) for m in polynomial), default=0)
        self._terms = [
            (c.numerator * (self._below // c.denominator), m, self._degree - sum(e for _, e in m))
            for m, c in polynomial.items()
        ]

    def value(self, x: Sequence[Fraction]) -> Fraction:
        """The exact value at x (n,)."""
        denominator = lcm(*(v.denominator for v in x))
        return self.value_of_ratios([v.numerator * (denominator // v.denominator) for v in x], denominator)

    def value_of_ratios(self, numerators: Sequence[int], denominator: int) -> Fraction:
        """The exact value at the point of these numerators (n,) over one denominator."""
        powers = [denominator**e for e in range(self._degree + 1)]
        total = 0
        for coefficient, monomial, left in self._terms:
            term = coefficient * powers[left]
            for v, e in monomial:
                term *= numerators[v] ** e
            total += term
        return Fraction(total, self._below * powers[-1])


def substitute(polynomial: ExactPolynomial, values: Mapping[int, Fraction]) -> ExactPolynomial:
    """The polynomial with some variables given values; the others are numbered anew without gaps."""

    def term(monomial: Powers, coefficient: Fraction) -> tuple[Powers, Fraction]:
        rest = []
        for v, e in monomial:
            if v in values:
                coefficient *= values[v] ** e
            else:
                rest.append((v - sum(k < v for k in values), e))
        return tuple(rest), coefficient

    return ExactPolynomial(collected(term(*one) for one in polynomial.items())).without_zeros()


def normalised(polynomial: ExactPolynomial) -> ExactPolynomial:
    """The polynomial times the power of two that brings its largest coefficient near 1.

    Its zeros stay, floats stay floats, and coefficients beyond the range of floats come into it.
    """
    sizes = [c.numerator.bit_length() - c.denominator.bit_length() for c in polynomial.values()]
    factor = Fraction(2) ** -max(sizes, default=0)
    return ExactPolynomial({m: c * factor for m, c in polynomial.items()})


def independent(polynomials: Sequence[ExactPolynomial]) -> list[ExactPolynomial]:
    """Polynomials with the same common zeros, linearly independent of each other (by elimination)."""
    out: list[ExactPolynomial] = []
    for polynomial in polynomials:
        rest = ExactPolynomial(polynomial)
        for known in out:
            pivot = next(iter(known))
            factor = rest.get(pivot, Fraction(0)) / known[pivot]
            if factor:
                rest.add(known, -factor)
        if rest:
            out.append(rest)
    return out


def simplest_between(low: Fraction, high: Fraction) -> Fraction:
    """The rational number with the smallest denominator in [low, high]."""
    if low <= 0 <= high:
        return Fraction(0)
    if high < 0:
        return -simplest_between(-high, -low)
    # Continued fractions: take whole parts off while both ends share them.
    parts = []
    while True:
        whole = floor(low)
        if whole == low:
            parts.append(whole)
            break
        if whole + 1 <= high:
            parts.append(whole + 1)
            break
        parts.append(whole)
        low, high = 1 / (high - whole), 1 / (low - whole)
    value = Fraction(parts[-1])
    for whole in reversed(parts[:-1]):
        value = whole + 1 / value
    return value
