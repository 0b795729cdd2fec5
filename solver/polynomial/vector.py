"""Vectors of three polynomials: points and directions whose coordinates are polynomials."""

from collections.abc import Sequence

from ...base.numeric.arrays import Array
from .polynomial import Polynomial, total

__all__ = ["Vector", "combine", "constant_vector", "difference", "dot"]

Vector = list[Polynomial]


def constant_vector(v: Array) -> Vector:
    """The constant vector v (3,)."""
    return [Polynomial.constant(float(x)) for x in v]


def dot(a: Vector, b: Vector) -> Polynomial:
    """The inner product."""
    return total(x * y for x, y in zip(a, b, strict=True))


def difference(a: Vector, b: Vector) -> Vector:
    """The difference a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def combine(coefficients: Sequence[Polynomial | float] | Array, vectors: Sequence[Vector]) -> Vector:
    """The sum of the vectors, each times its coefficient."""
    return [total(v[i] * c for c, v in zip(coefficients, vectors, strict=True)) for i in range(3)]
