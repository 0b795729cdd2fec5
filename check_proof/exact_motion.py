"""How parts of regions move along a twist of the object, in whole numbers."""

from math import isqrt
from typing import Any, NamedTuple

import numpy as np

from .exact_regions import ExactPart, convolve

__all__ = ["Moved", "moved", "product", "root_above"]


class Moved(NamedTuple):
    """How a part moves along a twist, by control points with their binomials, of whole numbers.

    Attributes:
        towards: w v . m, as P / w is the point.
        across: the three components of w v x m.
        about: w (angular part) . m.
        spin: the three components of w (angular part).
        normals: the three components of m.
    """

    towards: Any
    across: list[Any]
    about: Any
    spin: list[Any]
    normals: list[Any]


def moved(part: ExactPart, twist: list[int]) -> Moved:
    """The motion of a part along a twist."""
    a, (x, y, z) = twist[:3], twist[3:]
    P, w = part.points[..., :3], part.points[..., 3]
    turned = (y * P[..., 2] - z * P[..., 1], z * P[..., 0] - x * P[..., 2], x * P[..., 1] - y * P[..., 0])
    v = [w * a[c] + turned[c] for c in range(3)]
    spin = [w * twist[3 + c] for c in range(3)]
    m = [part.normals[..., c] for c in range(3)]
    across = [
        product(v[(c + 1) % 3], m[(c + 2) % 3]) - product(v[(c + 2) % 3], m[(c + 1) % 3]) for c in range(3)
    ]
    towards = sum(product(v[c], m[c]) for c in range(3))
    return Moved(towards, across, sum(product(spin[c], m[c]) for c in range(3)), spin, m)


def root_above(squares: Any) -> Any:
    """Whole numbers above the square roots of whole numbers."""
    return np.array([isqrt(x) + 1 for x in squares.ravel()], dtype=object).reshape(squares.shape)


def product(a: Any, b: Any) -> Any:
    """The product of two scalar forms (., .)."""
    return convolve(a, b, lambda one, net: one * net)
