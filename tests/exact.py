"""Rational arithmetic, the oracle of what is computed in floats and intervals."""

from collections.abc import Sequence
from fractions import Fraction
from math import comb

import numpy as np
from holdfast.solver.interval import COSINE
from holdfast.solver.polynomial.polynomial import Polynomial
from holdfast.solver.polynomial.system import BernsteinFunction, PolynomialSystem, TrigFunction


class Exact:
    """Rational arithmetic on the same data that the code under test works on in floats."""

    @staticmethod
    def polynomial(p: Polynomial, x: Sequence[Fraction]) -> Fraction:
        out = Fraction(0)
        for monomial, coefficient in p.terms.items():
            term = Fraction(coefficient)
            for i in monomial:
                term *= x[i]
            out += term
        return out

    @staticmethod
    def bernstein(coefficients: np.ndarray, u: Fraction, v: Fraction) -> Fraction:
        m, n = (k - 1 for k in coefficients.shape)
        return sum(
            (
                Fraction(float(coefficients[i, j]))
                * (comb(m, i) * u**i * (1 - u) ** (m - i))
                * (comb(n, j) * v**j * (1 - v) ** (n - j))
                for i in range(m + 1)
                for j in range(n + 1)
            ),
            Fraction(0),
        )

    @staticmethod
    def cosine_and_sine(angle: Fraction) -> tuple[Fraction, Fraction]:
        """To within 1e-80, for angles up to 60 rad: Taylor's series as it stands, without pi."""
        one = 1 << 400
        x, term, sums = int(angle * one), one, [0, 0]
        for k in range(1, 400):
            sums[(k - 1) % 2] += term if (k - 1) % 4 < 2 else -term
            term = term * x // one // k
        return Fraction(sums[0], one), Fraction(sums[1], one)

    @classmethod
    def trig(cls, f: TrigFunction, x: Fraction) -> Fraction:
        """The function at x, as `cosine_and_sine` has it."""
        cosine, sine = cls.cosine_and_sine(Fraction(f.ratio) * x + Fraction(f.offset))
        return cosine if f.kind == COSINE else sine

    @classmethod
    def ends(cls, x: Sequence[Fraction]) -> tuple[np.ndarray, np.ndarray]:
        """The smallest box of floats that holds a point."""
        return np.array([cls.below(v) for v in x]), np.array([cls.above(v) for v in x])

    @classmethod
    def define(cls, system: PolynomialSystem, x: list[Fraction]) -> None:
        """Fills the defined variables of `x` (n,) from its inputs."""
        for k, value in system.definitions.items():
            if isinstance(value, BernsteinFunction):
                x[k] = cls.bernstein(value.coefficients, x[value.i], x[value.j])
            elif isinstance(value, TrigFunction):
                x[k] = cls.trig(value, x[value.i])
            else:
                x[k] = cls.polynomial(value, x)

    @staticmethod
    def below(value: Fraction) -> float:
        """The largest float at or below."""
        out = float(value)
        return out if Fraction(out) <= value else float(np.nextafter(out, -np.inf))

    @staticmethod
    def above(value: Fraction) -> float:
        """The smallest float at or above."""
        out = float(value)
        return out if Fraction(out) >= value else float(np.nextafter(out, np.inf))

    @staticmethod
    def within(x: Sequence[Fraction], lower: np.ndarray, upper: np.ndarray) -> bool:
        """Whether the exact point lies in the box."""
        return all(
            Fraction(float(lo)) <= value <= Fraction(float(hi))
            for value, lo, hi in zip(x, lower, upper, strict=True)
        )
