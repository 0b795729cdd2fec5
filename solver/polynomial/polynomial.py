"""Sparse polynomials in numbered variables, for building systems (not for inner loops)."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

import numpy as np

from ...base.numeric.arrays import Array

__all__ = ["Monomial", "Polynomial"]

# Indices of the factors in ascending order, repeated for powers: x_2^2 x_5 is (2, 2, 5), a constant is ().
Monomial: TypeAlias = tuple[int, ...]


class Polynomial:
    """A polynomial with float coefficients, taken as exact numbers; supports +, - and *."""

    __slots__ = ("terms",)

    def __init__(self, terms: Mapping[Monomial, float] | None = None):
        self.terms = {m: float(c) for m, c in (terms or {}).items() if c != 0.0}

    @classmethod
    def constant(cls, value: float) -> "Polynomial":
        """The constant polynomial."""
        return cls({(): value})

    @classmethod
    def variable(cls, index: int) -> "Polynomial":
        """The variable number `index`."""
        return cls({(index,): 1.0})

    @property
    def degree(self) -> int:
        """Total degree; 0 for constants."""
        return max((len(m) for m in self.terms), default=0)

    @property
    def variables(self) -> frozenset[int]:
        """Indices of the variables that occur."""
        return frozenset(i for m in self.terms for i in m)

    def __add__(self, other: "Polynomial | float") -> "Polynomial":
        terms = dict(self.terms)
        for m, c in _as_polynomial(other).terms.items():
            terms[m] = terms.get(m, 0.0) + c
        return Polynomial(terms)

    __radd__ = __add__

    def __neg__(self) -> "Polynomial":
        return Polynomial({m: -c for m, c in self.terms.items()})

    def __sub__(self, other: "Polynomial | float") -> "Polynomial":
        return self + (-_as_polynomial(other))

    def __rsub__(self, other: float) -> "Polynomial":
        return _as_polynomial(other) - self

    def __mul__(self, other: "Polynomial | float") -> "Polynomial":
        terms: dict[Monomial, float] = {}
        for m, c in self.terms.items():
            for n, d in _as_polynomial(other).terms.items():
                key = tuple(sorted(m + n))
                terms[key] = terms.get(key, 0.0) + c * d
        return Polynomial(terms)

    __rmul__ = __mul__

    def evaluate(self, x: Array) -> float:
        """Value at the point `x` (n,), in ordinary floats."""
        return float(sum(c * np.prod(x[list(m)]) if m else c for m, c in self.terms.items()))


def _as_polynomial(value: "Polynomial | float") -> Polynomial:
    return value if isinstance(value, Polynomial) else Polynomial.constant(float(value))


def total(polynomials: Iterable[Polynomial]) -> Polynomial:
    """Sum of polynomials."""
    out = Polynomial()
    for p in polynomials:
        out = out + p
    return out
