"""Polynomial systems as the solver takes them, and a builder that names their parts.

A system has *inputs* (free variables with an interval each), *definitions* (a variable that equals a
polynomial or a Bernstein function of earlier ones, or a cosine or sine of one), *equations* that the inputs
must satisfy, *redundant* equations that follow from the others and only help to prune, and *inequalities*.
Inputs and equations alone decide existence.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import structural_rank

from ...base.numeric.arrays import Array, Indices
from ..interval import COSINE, add, mul, power, scale, trig_range
from .polynomial import Polynomial

__all__ = [
    "BernsteinFunction",
    "Definition",
    "PolynomialSystem",
    "SystemBuilder",
    "TrigFunction",
    "bound_polynomial",
    "bounds_itself",
]

# Initial intervals of cosines and sines are wider than what is enclosed by this much, so that rounding never
# takes an enclosure over a part of the box out of them.
_TRIG_ROOM = 1e-12


@dataclass(frozen=True, eq=False)
class BernsteinFunction:
    """x_k = f(x_i, x_j) with f in Bernstein form over [0, 1]^2 (paper, equation 32).

    Attributes:
        i: index of the first parameter.
        j: index of the second parameter.
        coefficients: (d_i + 1, d_j + 1).
    """

    i: int
    j: int
    coefficients: Array

    @property
    def variables(self) -> frozenset[int]:
        """Indices of the parameters."""
        return frozenset((self.i, self.j))


@dataclass(frozen=True)
class TrigFunction:
    """x_k = cos or sin of (ratio x_i + offset); the numbers are taken as exact.

    Attributes:
        i: index of the variable.
        kind: `COSINE` or `SINE`.
        ratio: above zero.
        offset: in rad.
    """

    i: int
    kind: int
    ratio: float
    offset: float

    @property
    def variables(self) -> frozenset[int]:
        """Index of the variable."""
        return frozenset((self.i,))

    def range_over(self, lower: float, upper: float) -> tuple[float, float]:
        """Enclosure of the values where x_i lies in [lower, upper]."""
        al, au = add(*scale(self.ratio, lower, upper), self.offset, self.offset)
        low, high = trig_range(self.kind, al, au)
        return float(low), float(high)


Definition: TypeAlias = Polynomial | BernsteinFunction | TrigFunction


@dataclass(frozen=True, eq=False)
class PolynomialSystem:
    """A system of polynomial equations over a box, in variables some of which may be functions of others.

    Attributes:
        names: (n,) names of the variables.
        lower: (n,) lower ends of the initial box.
        upper: (n,) upper ends of the initial box.
        definitions: variable -> what it equals, each made of earlier variables.
        equations: polynomials that must be zero.
        redundant: polynomials that are zero at every solution of the others.
        inequalities: polynomials that must be at least zero.
    """

    names: tuple[str, ...]
    lower: Array
    upper: Array
    definitions: dict[int, Definition]
    equations: tuple[Polynomial, ...]
    redundant: tuple[Polynomial, ...]
    inequalities: tuple[Polynomial, ...]

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.names)

    @cached_property
    def inputs(self) -> Indices:
        """Indices of the variables that no definition fixes."""
        return np.array([i for i in range(self.size) if i not in self.definitions], dtype=np.int64)

    @property
    def dimension(self) -> int:
        """Inputs less equations: the dimension of the solution set where all is regular."""
        return len(self.inputs) - len(self.equations)

    @property
    def is_algebraic(self) -> bool:
        """Whether everything is a polynomial in the inputs: whether no cosine or sine is defined."""
        return not any(isinstance(value, TrigFunction) for value in self.definitions.values())

    @property
    def is_overdetermined(self) -> bool:
        """Whether some of the equations have fewer inputs among them than they are (by who occurs where)."""
        reach: dict[int, frozenset[int]] = {int(i): frozenset([int(i)]) for i in self.inputs}
        for k, value in self.definitions.items():
            reach[k] = frozenset().union(*(reach[i] for i in value.variables))
        occurs = np.zeros((len(self.equations), self.size))
        for row, equation in zip(occurs, self.equations, strict=True):
            row[sorted(frozenset().union(*(reach[i] for i in equation.variables)))] = 1.0
        rank = structural_rank(csr_array(occurs)) if occurs.size else 0
        return bool(rank < len(self.equations))


@dataclass
class SystemBuilder:
    """Collects variables and equations; products of linear forms get variables of their own, each once."""

    names: list[str] = field(default_factory=list)
    lower: list[float] = field(default_factory=list)
    upper: list[float] = field(default_factory=list)
    definitions: dict[int, Definition] = field(default_factory=dict)
    equations: list[Polynomial] = field(default_factory=list)
    redundant: list[Polynomial] = field(default_factory=list)
    inequalities: list[Polynomial] = field(default_factory=list)
    _known: dict[tuple[tuple[tuple[int, ...], float], ...], Polynomial] = field(default_factory=dict)
    _known_trig: dict[TrigFunction, Polynomial] = field(default_factory=dict)

    def variable(self, name: str, lower: float, upper: float) -> Polynomial:
        """A new input in [lower, upper]."""
        self.names.append(name)
        self.lower.append(float(lower))
        self.upper.append(float(upper))
        return Polynomial.variable(len(self.names) - 1)

    def define(
        self, name: str, value: Polynomial, lower: float = -np.inf, upper: float = np.inf
    ) -> Polynomial:
        """A new variable equal to `value`, its interval computed and cut to [lower, upper].

        The same polynomial is defined once; a later call gets the earlier variable.
        """
        key = tuple(sorted(value.terms.items()))
        if key in self._known:
            return self._known[key]
        lo, hi = bound_polynomial(value, self.lower, self.upper)
        out = self.variable(name, max(lo, lower), min(hi, upper))
        self.definitions[len(self.names) - 1] = value
        self._known[key] = out
        return out

    def form(self, name: str, value: Polynomial) -> Polynomial:
        """`value` itself where it is a multiple of one variable or constant, else a variable equal to it."""
        return value if len(value.terms) <= 1 and value.degree <= 1 else self.define(name, value)

    def product(self, name: str, a: Polynomial, b: Polynomial) -> Polynomial:
        """The product of two polynomials, with sums first turned into variables."""
        if a.degree == 0 or b.degree == 0:
            return a * b
        return self.form(f"{name}.a", a) * self.form(f"{name}.b", b)

    def bernstein(self, name: str, u: Polynomial, v: Polynomial, coefficients: Array) -> Polynomial:
        """A new variable equal to a Bernstein function of two variables in [0, 1]."""
        (i,), (j,) = u.variables, v.variables
        self.names.append(name)
        # The hull of the coefficients, with room for rounding and for parameters that leave [0, 1] by 1e-9.
        room = 1e-7 * float(np.abs(coefficients).max() + 1e-300)
        self.lower.append(float(coefficients.min()) - room)
        self.upper.append(float(coefficients.max()) + room)
        self.definitions[len(self.names) - 1] = BernsteinFunction(i, j, np.array(coefficients))
        return Polynomial.variable(len(self.names) - 1)

    def trig(self, name: str, x: Polynomial, kind: int, ratio: float, offset: float) -> Polynomial:
        """Cosine or sine (`kind`) of ratio x + offset, x a variable; the same function is defined once."""
        (i,) = x.variables
        function = TrigFunction(i, kind, abs(ratio), offset if ratio > 0.0 else 0.0 - offset)
        sign = 1.0 if ratio > 0.0 or kind == COSINE else -1.0
        if function not in self._known_trig:
            low, high = function.range_over(self.lower[i], self.upper[i])
            self._known_trig[function] = self.variable(name, low - _TRIG_ROOM, high + _TRIG_ROOM)
            self.definitions[len(self.names) - 1] = function
        return self._known_trig[function] * sign

    def equate(self, value: Polynomial) -> None:
        """Requires the polynomial to be zero."""
        self.equations.append(value)

    def imply(self, value: Polynomial) -> None:
        """Adds a polynomial that is zero at every solution anyway."""
        self.redundant.append(value)

    def at_least_zero(self, value: Polynomial) -> None:
        """Requires the polynomial to be at least zero."""
        self.inequalities.append(value)

    def build(self) -> PolynomialSystem:
        """The finished system."""
        return PolynomialSystem(
            tuple(self.names),
            np.array(self.lower),
            np.array(self.upper),
            dict(self.definitions),
            tuple(self.equations),
            tuple(self.redundant),
            tuple(self.inequalities),
        )


def bounds_itself(
    k: int, value: Polynomial, lower: Sequence[float] | Array, upper: Sequence[float] | Array
) -> bool:
    """Whether variable k, defined as `value`, lies in its interval wherever the variables of `value` do."""
    low, high = bound_polynomial(value, lower, upper)
    return bool(lower[k] <= low and high <= upper[k])


def bound_polynomial(
    polynomial: Polynomial, lower: Sequence[float] | Array, upper: Sequence[float] | Array
) -> tuple[float, float]:
    """An enclosure of the polynomial's values over a box, term by term in outward-rounded arithmetic."""
    lo, hi = 0.0, 0.0
    for monomial, coefficient in polynomial.terms.items():
        tl, tu = coefficient, coefficient
        for i in sorted(set(monomial)):
            pl, pu = power(float(lower[i]), float(upper[i]), monomial.count(i))
            tl, tu = mul(tl, tu, pl, pu)
        lo, hi = add(lo, hi, tl, tu)
    return float(lo), float(hi)
