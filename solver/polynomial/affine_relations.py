"""Variables of a polynomial system that are fixed, or related to another one by x = scale y + shift."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from math import isfinite
from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from .polynomial import Monomial, Polynomial
from .system import Definition

__all__ = [
    "Affine",
    "affine_definitions",
    "fixed_inputs",
    "proportional",
    "related_inputs",
]


class Affine(NamedTuple):
    """x = scale y + shift, where scale is zero for a fixed x; `source` is the equation that says so."""

    x: int
    scale: Fraction
    y: int
    shift: Fraction
    source: int | None = None


def fixed_inputs(lower: Array, upper: Array, is_input: Callable[[int], bool]) -> Iterator[Affine]:
    """Inputs whose interval, of lower and upper (n,), is a point."""
    for x in np.flatnonzero(lower == upper).tolist():
        if is_input(x) and isfinite(lower[x]):
            yield Affine(x, Fraction(0), x, Fraction(float(lower[x])))


def affine_definitions(definitions: Mapping[int, Definition]) -> Iterator[Affine]:
    """Definitions that are constant, linear in one variable, or like an earlier one."""
    known: dict[tuple[Monomial, ...], list[tuple[int, Polynomial]]] = {}
    for x, value in definitions.items():
        if not isinstance(value, Polynomial):
            continue
        monomials = tuple(sorted(m for m in value.terms if m))
        if not monomials:
            yield Affine(x, Fraction(0), x, _coefficient(value, ()))
        elif len(monomials) == 1 and value.degree == 1:
            yield Affine(x, _coefficient(value, monomials[0]), monomials[0][0], _coefficient(value, ()))
        else:
            alike = known.setdefault(monomials, [])
            for y, like in alike:
                relation = _relation_of_alike(x, value, y, like)
                if relation is not None:
                    yield relation
            alike.append((x, value))


def _relation_of_alike(x: int, p: Polynomial, y: int, q: Polynomial) -> Affine | None:
    """The relation of x = p to y = q, which have the same monomials, if their coefficients allow one."""
    first, *others = (m for m in p.terms if m)
    if any(not proportional(p.terms[m], q.terms[m], p.terms[first], q.terms[first]) for m in others):
        return None
    scale = _coefficient(p, first) / _coefficient(q, first)
    return Affine(x, scale, y, _coefficient(p, ()) - scale * _coefficient(q, ()))


def proportional(a: float, b: float, c: float, d: float) -> bool:
    """Whether a : b = c : d, exactly."""
    if (a, b) == (c, d) or (a == b and c == d) or (a == -b and c == -d):
        return True
    return abs(a * d - b * c) <= 1e-14 * abs(b * c) and Fraction(a) * Fraction(d) == Fraction(b) * Fraction(c)


def _coefficient(polynomial: Polynomial, monomial: Monomial) -> Fraction:
    return Fraction(polynomial.terms.get(monomial, 0.0))


def related_inputs(equations: Sequence[Polynomial], is_input: Callable[[int], bool]) -> Iterator[Affine]:
    """Linear equations in one input, or in two inputs, of which the later one goes."""
    for number, equation in enumerate(equations):
        variables = sorted(equation.variables)
        if equation.degree != 1 or len(variables) > 2 or not all(map(is_input, variables)):
            continue
        y, x = variables[0], variables[-1]
        divisor = Fraction(equation.terms[x,])
        shift = -Fraction(equation.terms.get((), 0.0)) / divisor
        scale = Fraction(0) if x == y else -Fraction(equation.terms[y,]) / divisor
        yield Affine(x, scale, y, shift, number)
