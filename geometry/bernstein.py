"""Bernstein polynomials in floats: on arrays for whole patches, and compiled for inner loops.

Enclosures of them are in `solver/enclosure/bernstein.py`, exact ones in `solver/polynomial/elimination.py`.
"""

from functools import lru_cache
from math import comb

import numpy as np

from ..base.machine.jit import compiled
from ..base.numeric.arrays import Array

__all__ = ["bernstein", "bernstein_jets", "bernstein_product", "de_casteljau", "split_at"]


def bernstein(degree: int, x: Array | float) -> Array:
    """Bernstein polynomials B_{0..degree, degree} at `x`; shape (*x.shape, degree + 1)."""
    x = np.asarray(x, dtype=float)[..., None]
    binomials, up, down = _row(degree)
    return binomials * x**up * (1.0 - x) ** down


@lru_cache(maxsize=64)
def _row(degree: int) -> tuple[Array, Array, Array]:
    """Binomial coefficients (degree + 1,) of a degree, and the powers of x and of 1 - x beside them."""
    i = np.arange(degree + 1, dtype=float)
    return np.array([comb(degree, k) for k in range(degree + 1)], dtype=float), i, degree - i


def bernstein_product(a: Array, b: Array) -> Array:
    """Bernstein coefficients of the product of two scalar bivariate Bernstein polynomials.

    Args:
        a: coefficients (m + 1, n + 1).
        b: coefficients (p + 1, q + 1).

    Returns:
        Coefficients (m + p + 1, n + q + 1).
    """
    (m, n), (p, q) = np.array(a.shape) - 1, np.array(b.shape) - 1
    weighted = b * _binomials(p, q)
    out = np.zeros((m + p + 1, n + q + 1))
    for (i, j), w in np.ndenumerate(a * _binomials(m, n)):
        out[i : i + p + 1, j : j + q + 1] += w * weighted
    return out / _binomials(m + p, n + q)


def _binomials(m: int, n: int) -> Array:
    """Products of binomial coefficients C(m, i) C(n, j), shape (m + 1, n + 1)."""
    return np.outer([comb(m, i) for i in range(m + 1)], [comb(n, j) for j in range(n + 1)]).astype(float)


def split_at(points: Array, t: float) -> tuple[Array, Array]:
    """Splits control points along axis 0 at `t` into those of [0, t] and [t, 1]."""
    left, right = [points[0]], [points[-1]]
    while len(points) > 1:
        points = (1.0 - t) * points[:-1] + t * points[1:]
        left.append(points[0])
        right.append(points[-1])
    return np.array(left), np.array(right[::-1])


@compiled
def de_casteljau(b: Array, x: float) -> float:
    """The polynomial with the Bernstein coefficients b, which are overwritten, at x."""
    for rows in range(len(b) - 1, 0, -1):
        for a in range(rows):
            b[a] = (1.0 - x) * b[a] + x * b[a + 1]
    return float(b[0])


@compiled
def _basis(degree: int, x: float) -> Array:
    """Bernstein polynomials of `degree` at `x`, by their recursion."""
    b = np.zeros(degree + 1)
    b[0] = 1.0
    for d in range(1, degree + 1):
        b[d] = x * b[d - 1]
        for i in range(d - 1, 0, -1):
            b[i] = (1.0 - x) * b[i] + x * b[i - 1]
        b[0] *= 1.0 - x
    return b


@compiled
def bernstein_jets(degree: int, x: float) -> tuple[Array, Array, Array]:
    """Bernstein polynomials with their first and second derivatives."""
    b, b1, b2 = _basis(degree, x), np.zeros(degree + 1), np.zeros(degree + 1)
    lower = _basis(degree - 1, x)
    for i in range(degree):
        b1[i] -= degree * lower[i]
        b1[i + 1] += degree * lower[i]
    if degree >= 2:
        lower = _basis(degree - 2, x)
        for i in range(degree - 1):
            w = degree * (degree - 1) * lower[i]
            b2[i] += w
            b2[i + 1] -= 2.0 * w
            b2[i + 2] += w
    return b, b1, b2
