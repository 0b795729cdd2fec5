"""Arrays of numbers known to within a radius, rounded outward: midpoint and radius.

An operation on midpoints rounds to nearest, and the radius of its result takes that rounding up, as well as
those of its own arithmetic (Rump, "Fast and parallel interval arithmetic", BIT 39, 1999). Products of
matrices then cost a few of numpy's, where intervals by their ends would cost a compiled loop each.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from .trigonometry import COSINE, SINE, trig_range

__all__ = ["Balls"]

# Half the distance from 1 to the next float, and more than what can be lost below all floats.
_HALF_ULP, _TINY = 2.0**-53, 1e-300


@dataclass(frozen=True, eq=False)
class Balls:
    """True numbers x with |x - mid| <= rad; arrays of one shape.

    Attributes:
        mid: midpoints.
        rad: radii; infinite where nothing is known.
    """

    mid: Array
    rad: Array

    # What is an array beside a ball counts as exact.
    __array_ufunc__ = None

    @classmethod
    def exact(cls, values: Any) -> "Balls":
        """Floats as they are."""
        mid = np.asarray(values, dtype=float)
        return cls(mid, np.zeros(mid.shape))

    @classmethod
    def between(cls, lower: Any, upper: Any) -> "Balls":
        """Numbers from `lower` to `upper`."""
        lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
        mid = 0.5 * lower + 0.5 * upper
        return cls(mid, _raised(np.maximum(upper - mid, mid - lower), 2))

    @classmethod
    def within(cls, mid: Any, radius: Any) -> "Balls":
        """Numbers at most `radius` from floats."""
        mid = np.asarray(mid, dtype=float)
        return cls(mid, np.broadcast_to(np.asarray(radius, dtype=float), mid.shape))

    @classmethod
    def stack(cls, balls: "list[Balls]", axis: int = 0) -> "Balls":
        """Arrays of one shape side by side along a new axis."""
        return cls(np.stack([b.mid for b in balls], axis), np.stack([b.rad for b in balls], axis))

    @property
    def shape(self) -> tuple[int, ...]:
        """Of both arrays."""
        return self.mid.shape

    @property
    def lower(self) -> Array:
        """Floats below the numbers."""
        return np.asarray(np.nextafter(self.mid - self.rad, -np.inf))

    @property
    def upper(self) -> Array:
        """Floats above the numbers."""
        return np.asarray(np.nextafter(self.mid + self.rad, np.inf))

    @property
    def most(self) -> Array:
        """Floats above the absolute values."""
        return np.asarray(np.nextafter(np.abs(self.mid) + self.rad, np.inf))

    @property
    def T(self) -> "Balls":
        """The matrix with rows and columns exchanged."""
        return Balls(self.mid.T, self.rad.T)

    def __getitem__(self, key: Any) -> "Balls":
        return Balls(self.mid[key], self.rad[key])

    def __neg__(self) -> "Balls":
        return Balls(-self.mid, self.rad)

    def __add__(self, other: "Balls | Array | float") -> "Balls":
        b = _balls(other)
        mid = self.mid + b.mid
        return Balls(mid, _raised(self.rad + b.rad + _HALF_ULP * np.abs(mid), 3))

    __radd__ = __add__

    def __sub__(self, other: "Balls | Array | float") -> "Balls":
        return self + -_balls(other)

    def __rsub__(self, other: "Balls | Array | float") -> "Balls":
        return _balls(other) + -self

    def __mul__(self, other: "Balls | Array | float") -> "Balls":
        b = _balls(other)
        with np.errstate(invalid="ignore"):  # nothing times what is unknown
            mid = self.mid * b.mid
            rad = np.abs(self.mid) * b.rad + self.rad * (np.abs(b.mid) + b.rad) + _HALF_ULP * np.abs(mid)
        return Balls(mid, _raised(rad, 6))

    __rmul__ = __mul__

    def __matmul__(self, other: "Balls | Array") -> "Balls":
        return _product(self, _balls(other))

    def __rmatmul__(self, other: "Balls | Array") -> "Balls":
        return _product(_balls(other), self)

    def __truediv__(self, other: "Balls | Array | float") -> "Balls":
        return self * _inverse(_balls(other))

    def __rtruediv__(self, other: "Balls | Array | float") -> "Balls":
        return _balls(other) * _inverse(self)

    def sqrt(self) -> "Balls":
        """Square roots; unknown where a number may lie below zero or be zero."""
        with np.errstate(invalid="ignore", divide="ignore"):
            mid = np.sqrt(self.mid)
            # |sqrt x - sqrt m| = |x - m| / (sqrt x + sqrt m) <= |x - m| / sqrt m
            rad = _raised(self.rad / mid + _HALF_ULP * mid, 6)
        known = (self.mid > 0.0) & (self.rad <= self.mid)
        return Balls(np.where(known, mid, 0.0), np.where(known, rad, np.inf))

    def sum(self, axis: int | None = None) -> "Balls":
        """Sum along an axis, or of everything."""
        count = self.mid.size if axis is None else self.mid.shape[axis]
        rad = self.rad.sum(axis=axis) + (count + 1) * _HALF_ULP * np.abs(self.mid).sum(axis=axis)
        return Balls(np.asarray(self.mid.sum(axis=axis)), _raised(rad, 2 * count + 4))

    def cosine(self) -> "Balls":
        """Cosines of angles in rad."""
        return _trig(COSINE, self)

    def sine(self) -> "Balls":
        """Sines of angles in rad."""
        return _trig(SINE, self)

    def cross(self, other: "Balls | Array") -> "Balls":
        """Vector products of the last axes, of length 3; shapes are broadcast."""
        b = _balls(other)
        first, second = np.array([1, 2, 0]), np.array([2, 0, 1])
        return self[..., first] * b[..., second] - self[..., second] * b[..., first]

    def unit(self) -> "Balls":
        """Vectors (3,) along the last axis divided by their length."""
        length = (self * self).sum(axis=-1).sqrt()
        return self / Balls(length.mid[..., None], length.rad[..., None])


def _balls(value: Any) -> Balls:
    return value if isinstance(value, Balls) else Balls.exact(value)


def _raised(rad: Any, roundings: int) -> Array:
    """A radius worked out of non-negative numbers with so many roundings, made no smaller than the true one.

    What is not a number, as of infinity less infinity, is unknown.
    """
    out = np.asarray(rad * (1.0 + (roundings + 2) * 2.0 * _HALF_ULP) + _TINY)
    return np.where(np.isnan(out), np.inf, out)


def _product(a: Balls, b: Balls) -> Balls:
    """Product of matrices; a sum of k products is off by k + 1 half ulps of the absolute one."""
    k = a.shape[-1]
    size_a, size_b = np.abs(a.mid), np.abs(b.mid)
    with np.errstate(invalid="ignore"):
        rad = size_a @ (b.rad + (k + 1) * _HALF_ULP * size_b) + a.rad @ (size_b + b.rad)
    return Balls(a.mid @ b.mid, _raised(rad, 2 * k + 8))


def _inverse(b: Balls) -> Balls:
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mid = 1.0 / b.mid
        size = np.abs(b.mid)
        least = np.nextafter(size - b.rad, -np.inf)
        # |1/x - 1/m| = |x - m| / |x m|
        rad = _raised(b.rad / (size * least) + _HALF_ULP * np.abs(mid), 8)
    known = least > 0.0
    return Balls(np.where(known, mid, 0.0), np.where(known, rad, np.inf))


def _trig(kind: int, x: Balls) -> Balls:
    """Both functions change by no more than their argument."""
    ends = np.array([trig_range(kind, value, value) for value in x.mid.ravel().tolist()]).reshape(-1, 2)
    at = Balls.between(ends[:, 0], ends[:, 1])
    return Balls(at.mid.reshape(x.shape), _raised(at.rad.reshape(x.shape) + x.rad, 2))
