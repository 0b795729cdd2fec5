"""Polynomials with rational coefficients, worked on exactly: values, substitution, linear dependence."""

import math
import sys
from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import floor, lcm

from .parse import ExactPolynomial

__all__ = [
    "WholeForm",
    "enclose_fraction",
    "evaluate",
    "independent",
    "normalised",
    "simplest_between",
    "substitute",
]


def evaluate(polynomial: ExactPolynomial, x: Sequence[Fraction]) -> Fraction:
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

    def __init__(self, polynomial: ExactPolynomial):
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
    out: ExactPolynomial = {}
    for monomial, coefficient in polynomial.items():
        term = coefficient
        rest = []
        for v, e in monomial:
            if v in values:
                term *= values[v] ** e
            else:
                rest.append((v - sum(k < v for k in values), e))
        key = tuple(rest)
        out[key] = out.get(key, Fraction(0)) + term
    return {m: c for m, c in out.items() if c}


def normalised(polynomial: ExactPolynomial) -> ExactPolynomial:
    """The polynomial times the power of two that brings its largest coefficient near 1.

    Its zeros stay, floats stay floats, and coefficients beyond the range of floats come into it.
    """
    sizes = [c.numerator.bit_length() - c.denominator.bit_length() for c in polynomial.values()]
    factor = Fraction(2) ** -max(sizes, default=0)
    return {m: c * factor for m, c in polynomial.items()}


def independent(polynomials: Sequence[ExactPolynomial]) -> list[ExactPolynomial]:
    """Polynomials with the same common zeros, linearly independent of each other (by elimination)."""
    out: list[ExactPolynomial] = []
    for polynomial in polynomials:
        rest = dict(polynomial)
        for known in out:
            pivot = next(iter(known))
            factor = rest.get(pivot, Fraction(0)) / known[pivot]
            for m, c in known.items() if factor else ():
                value = rest.pop(m, Fraction(0)) - factor * c
                if value:
                    rest[m] = value
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
