"""Polynomial systems as the solver takes them, and a builder that names their parts.

A system has *inputs* (free variables with an interval each), *definitions* (a variable that equals a
polynomial or a Bernstein function of earlier ones), *equations* that the inputs must satisfy,
*redundant* equations that follow from the others and only help to prune, and *inequalities*. Inputs and
equations alone decide existence.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import structural_rank

from ...arrays import Array, Indices
from ..interval import add, mul, power
from .polynomial import Polynomial

__all__ = ["BernsteinFunction", "PolynomialSystem", "SystemBuilder", "bound_polynomial", "bounds_itself"]


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


@dataclass(frozen=True, eq=False)
class PolynomialSystem:
    """A system of polynomial equations over a box.

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
    definitions: dict[int, Polynomial | BernsteinFunction]
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
    def is_overdetermined(self) -> bool:
        """Whether some of the equations have fewer inputs among them than they are (by who occurs where)."""
        reach: dict[int, frozenset[int]] = {int(i): frozenset([int(i)]) for i in self.inputs}
        for k, value in self.definitions.items():
            used = value.variables if isinstance(value, Polynomial) else (value.i, value.j)
            reach[k] = frozenset().union(*(reach[i] for i in used))
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
    definitions: dict[int, Polynomial | BernsteinFunction] = field(default_factory=dict)
    equations: list[Polynomial] = field(default_factory=list)
    redundant: list[Polynomial] = field(default_factory=list)
    inequalities: list[Polynomial] = field(default_factory=list)
    _known: dict[tuple[tuple[tuple[int, ...], float], ...], Polynomial] = field(default_factory=dict)

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
