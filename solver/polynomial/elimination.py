"""Definitions of a polynomial system put into its equations, exactly."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import comb

import numpy as np

from .exact import ExactPolynomial, Powers, collected
from .polynomial import Polynomial
from .system import BernsteinFunction, PolynomialSystem, TrigFunction

__all__ = ["equations_in_inputs"]


def equations_in_inputs(system: PolynomialSystem) -> list[ExactPolynomial]:
    """The equations of an algebraic system as polynomials in the inputs alone.

    Coefficients are taken as exact numbers.
    """
    known = {int(i): ExactPolynomial.variable(int(i)) for i in system.inputs}
    for k, value in system.definitions.items():
        assert not isinstance(value, TrigFunction), "a cosine of an input is no polynomial"
        if isinstance(value, BernsteinFunction):
            known[k] = _bernstein(value, known[value.i], known[value.j])
        else:
            known[k] = _substituted(value, known)
    return [_substituted(equation, known) for equation in system.equations]


def _substituted(polynomial: Polynomial, known: Mapping[int, ExactPolynomial]) -> ExactPolynomial:
    """The polynomial with every variable replaced by what is known of it."""

    def expand() -> Iterator[tuple[Powers, Fraction]]:
        for monomial, coefficient in polynomial.terms.items():
            yield from _scaled_product(Fraction(coefficient), [known[v] for v in monomial]).items()

    return ExactPolynomial(collected(expand())).without_zeros()


def _bernstein(f: BernsteinFunction, u: ExactPolynomial, v: ExactPolynomial) -> ExactPolynomial:
    """The function of two polynomials, each in place of a parameter."""
    m, n = np.subtract(f.coefficients.shape, 1).tolist()
    rows, columns = _basis(m, u), _basis(n, v)

    def expand() -> Iterator[tuple[Powers, Fraction]]:
        for (i, j), coefficient in np.ndenumerate(f.coefficients):
            yield from _scaled_product(Fraction(float(coefficient)), [rows[i] * columns[j]]).items()

    return ExactPolynomial(collected(expand())).without_zeros()


def _basis(degree: int, x: ExactPolynomial) -> list[ExactPolynomial]:
    """Bernstein polynomials of x."""
    negative = {monomial: -c for monomial, c in x.items()}
    rest = ExactPolynomial(collected([*negative.items(), ((), Fraction(1))]))
    return [
        _scaled_product(Fraction(comb(degree, i)), [x] * i + [rest] * (degree - i)) for i in range(degree + 1)
    ]


def _scaled_product(coefficient: Fraction, factors: Sequence[ExactPolynomial]) -> ExactPolynomial:
    out = ExactPolynomial.constant(coefficient)
    for factor in factors:
        out = out * factor
    return out
