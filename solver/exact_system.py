"""Polynomials with rational coefficients, worked on exactly: values, substitution, linear dependence."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import floor

from .expression import ExactPolynomial

__all__ = ["evaluate", "independent", "normalised", "simplest_between", "substitute"]


def evaluate(polynomial: ExactPolynomial, x: Sequence[Fraction]) -> Fraction:
    """The exact value at x (n,)."""
    out = Fraction(0)
    for monomial, coefficient in polynomial.items():
        term = coefficient
        for v, e in monomial:
            term *= x[v] ** e
        out += term
    return out


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
