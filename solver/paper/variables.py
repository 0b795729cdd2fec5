"""Vectors of variables by name, each with equations of its own, as the paper counts them."""

from dataclasses import dataclass, field

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..polynomial import Polynomial, SystemBuilder, bound_polynomial, total

__all__ = ["PaperVariables", "Vector", "constant", "cross", "dot", "rotate"]

Vector = list[Polynomial]


@dataclass
class PaperVariables:
    """Adds named vectors of variables to a system.

    Unlike `SystemBuilder.define`, equal definitions are not shared: the paper writes each of its equations
    for each joint and contact, and so are its variables counted.

    Attributes:
        builder: receives variables and equations.
        indices: name -> indices of the variables.
    """

    builder: SystemBuilder
    indices: dict[str, Indices] = field(default_factory=dict)

    def inputs(self, name: str, count: int, lower: float, upper: float) -> Vector:
        """`count` free variables in [lower, upper]."""
        return self._named(name, [self.builder.variable(f"{name}{i}", lower, upper) for i in range(count)])

    def defined(self, name: str, values: Vector, lower: float, upper: float) -> Vector:
        """Variables that equal polynomials of earlier ones, cut to [lower, upper]."""
        return self._named(name, [self._define(f"{name}{i}", v, lower, upper) for i, v in enumerate(values)])

    def bezier(self, name: str, u: Polynomial, v: Polynomial, net: Array) -> Vector:
        """Three variables that equal a Bezier patch with control points `net` (M + 1, N + 1, 3)."""
        return self._named(name, [self.builder.bernstein(f"{name}{i}", u, v, net[..., i]) for i in range(3)])

    def bound(self, name: str) -> float:
        """A bound on the length of a vector."""
        ends = [self.builder.lower, self.builder.upper]
        return float(np.linalg.norm([max(abs(end[i]) for end in ends) for i in self.indices[name]]))

    def _define(self, name: str, value: Polynomial, lower: float, upper: float) -> Polynomial:
        lo, hi = bound_polynomial(value, self.builder.lower, self.builder.upper)
        out = self.builder.variable(name, max(lo, lower), min(hi, upper))
        self.builder.definitions[len(self.builder.names) - 1] = value
        return out

    def _named(self, name: str, vector: Vector) -> Vector:
        assert name not in self.indices, name
        self.indices[name] = np.array([i for p in vector for i in p.variables], dtype=np.int64)
        return vector


def constant(v: Array) -> Vector:
    """A vector of constants."""
    return [Polynomial.constant(float(x)) for x in v]


def dot(a: Vector, b: Vector) -> Polynomial:
    """The scalar product."""
    return total(x * y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product."""
    return [a[j] * b[k] - a[k] * b[j] for j, k in ((1, 2), (2, 0), (0, 1))]


def rotate(columns: list[Vector], v: Vector) -> Vector:
    """R v for a matrix R given by its columns."""
    return [total(columns[j][i] * v[j] for j in range(3)) for i in range(3)]
