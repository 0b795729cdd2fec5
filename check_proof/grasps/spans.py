"""Arrays of intervals by their ends, and the same with slopes: numbers whose derivatives are enclosed too.

Ends are moved to the neighbouring floats at every operation; cosines and sines come from whole numbers.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ..cosine import ERROR, ONE, cosine_and_sine, to_units
from ..intervals import down, mul, up

__all__ = ["Jets", "Numbers", "Spans", "cross", "dot", "matmul", "matvec", "stack", "unit"]


# Angles beyond this (rad) count as unknown.
_FARTHEST = 900.0


@dataclass(frozen=True, eq=False)
class Spans:
    """Numbers between `lo` and `hi`, arrays of one shape."""

    lo: Array
    hi: Array

    __array_ufunc__ = None

    @classmethod
    def of(cls, values: Any) -> "Spans":
        """Floats as they are."""
        exact = np.asarray(values, dtype=float)
        return cls(exact, exact)

    @classmethod
    def around(cls, values: Any, radius: Any) -> "Spans":
        """Numbers within `radius` of floats."""
        middle = np.asarray(values, dtype=float)
        return cls(down(middle - radius), up(middle + radius))

    @property
    def middle(self) -> Array:
        """Floats about half way."""
        return np.asarray(0.5 * self.lo + 0.5 * self.hi)

    @property
    def most(self) -> Array:
        """The largest absolute values."""
        return np.maximum(np.abs(self.lo), np.abs(self.hi))

    def __getitem__(self, key: Any) -> "Spans":
        return Spans(self.lo[key], self.hi[key])

    def __neg__(self) -> "Spans":
        return Spans(-self.hi, -self.lo)

    def __add__(self, other: Any) -> "Spans":
        if isinstance(other, Jets):
            return NotImplemented
        b = _spans(other)
        return Spans(down(self.lo + b.lo), up(self.hi + b.hi))

    def __sub__(self, other: Any) -> "Spans":
        if isinstance(other, Jets):
            return NotImplemented
        b = _spans(other)
        return Spans(down(self.lo - b.hi), up(self.hi - b.lo))

    def __mul__(self, other: Any) -> "Spans":
        if isinstance(other, Jets):
            return NotImplemented
        b = _spans(other)
        lo, hi = mul(self.lo, self.hi, b.lo, b.hi)
        return Spans(lo, hi)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> "Spans":
        return _spans(other) - self

    def sum(self, axis: int = -1) -> "Spans":
        """Sum along an axis, one after the other."""
        lo, hi = np.moveaxis(self.lo, axis, 0), np.moveaxis(self.hi, axis, 0)
        low, high = np.zeros(lo.shape[1:]), np.zeros(hi.shape[1:])
        for k in range(len(lo)):
            low, high = down(low + lo[k]), up(high + hi[k])
        return Spans(low, high)

    def inverse(self) -> "Spans":
        """1 / x; everything where x may be zero."""
        with np.errstate(divide="ignore"):
            a, b = 1.0 / self.hi, 1.0 / self.lo
        known = (self.lo > 0.0) | (self.hi < 0.0)
        return Spans(np.where(known, down(a), -np.inf), np.where(known, up(b), np.inf))

    def sqrt(self) -> "Spans":
        """The roots of what is not negative."""
        return Spans(
            np.maximum(down(np.sqrt(np.maximum(self.lo, 0.0))), 0.0), up(np.sqrt(np.maximum(self.hi, 0.0)))
        )

    def cosine_and_sine(self) -> "tuple[Spans, Spans]":
        """Of angles in rad; both change no faster than the angle."""
        # What the series is for; other angles, of forged files, are unknown.
        middle = np.where(self.most < _FARTHEST, self.middle, 0.0)
        units = [cosine_and_sine(to_units(Fraction(x))) for x in middle.ravel().tolist()]
        out = []
        for which in (0, 1):
            low = [down(float((pair[which] - ERROR - 1) / ONE)) for pair in units]
            high = [up(float((pair[which] + ERROR + 1) / ONE)) for pair in units]
            width = np.minimum(up(np.maximum(self.hi - middle, middle - self.lo)), 2.0)
            shape = middle.shape
            out.append(
                Spans(
                    down(np.reshape(np.array(low), shape) - width),
                    up(np.reshape(np.array(high), shape) + width),
                )
            )
        return out[0], out[1]


@dataclass(frozen=True, eq=False)
class Jets:
    """Numbers of shape S with their slopes, of shape (n, *S), by n unknowns, over a box of these."""

    value: Spans
    slopes: Spans

    __array_ufunc__ = None

    def __getitem__(self, key: Any) -> "Jets":
        inner = key if isinstance(key, tuple) else (key,)
        return Jets(self.value[key], self.slopes[(slice(None), *inner)])

    def __neg__(self) -> "Jets":
        return Jets(-self.value, -self.slopes)

    def __add__(self, other: Any) -> "Jets":
        a, b = _aligned(self, other)
        return Jets(self.value + _value(other), a + b)

    def __sub__(self, other: Any) -> "Jets":
        return self + -other

    def __mul__(self, other: Any) -> "Jets":
        mine, theirs = self.value, _spans(_value(other))
        a, b = _aligned(self, other)
        rank = a.lo.ndim - 1
        return Jets(mine * theirs, a * _lifted(theirs, rank) + b * _lifted(mine, rank))

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: Any) -> "Jets":
        return -self + other

    def sum(self, axis: int = -1) -> "Jets":
        """Sum along an axis."""
        axis = axis % self.value.lo.ndim
        return Jets(self.value.sum(axis), self.slopes.sum(axis + 1))

    def inverse(self) -> "Jets":
        """1 / x."""
        inverse = self.value.inverse()
        return Jets(inverse, -(self.slopes * (inverse * inverse)))

    def sqrt(self) -> "Jets":
        """Root of x."""
        root = self.value.sqrt()
        return Jets(root, self.slopes * (root * 2.0).inverse())

    def cosine_and_sine(self) -> "tuple[Jets, Jets]":
        """Of angles in rad."""
        cosine, sine = self.value.cosine_and_sine()
        return Jets(cosine, self.slopes * -sine), Jets(sine, self.slopes * cosine)


Numbers = Spans | Jets


def _spans(value: Any) -> Spans:
    return value if isinstance(value, Spans) else Spans.of(value)


def _value(x: Any) -> Any:
    return x.value if isinstance(x, Jets) else x


def _lifted(x: Spans, rank: int) -> Spans:
    """With axes of length 1 in front until it has so many, and one more for unknowns."""
    shape = (1,) * (1 + rank - x.lo.ndim) + x.lo.shape
    return Spans(x.lo.reshape(shape), x.hi.reshape(shape))


def _aligned(a: Jets, b: Any) -> tuple[Spans, Spans]:
    """Slopes of both with as many axes, the unknowns first; a constant has none."""
    rank = max(a.value.lo.ndim, np.ndim(_spans(_value(b)).lo))
    count = len(a.slopes.lo)

    def slopes(x: Any) -> Spans:
        if not isinstance(x, Jets):
            shape = np.shape(_spans(x).lo)
            zero = np.zeros((count, *(1,) * (rank - len(shape)), *shape))
            return Spans(zero, zero)
        shape = x.slopes.lo.shape[1:]
        new = (count, *(1,) * (rank - len(shape)), *shape)
        return Spans(x.slopes.lo.reshape(new), x.slopes.hi.reshape(new))

    return slopes(a), slopes(b)


def stack(rows: list[Any]) -> Any:
    """Numbers of one shape along a new first axis; constants among jets are allowed."""
    jets = [row for row in rows if isinstance(row, Jets)]
    if not jets:
        spans = [_spans(row) for row in rows]
        return Spans(np.stack([s.lo for s in spans]), np.stack([s.hi for s in spans]))
    full = [row if isinstance(row, Jets) else jets[0] * 0.0 + row for row in rows]
    return Jets(
        stack([row.value for row in full]),
        Spans(
            np.stack([row.slopes.lo for row in full], axis=1),
            np.stack([row.slopes.hi for row in full], axis=1),
        ),
    )


def dot(a: Any, b: Any) -> Any:
    """Scalar products along the last axis."""
    return (a * b).sum(-1)


def matvec(A: Any, v: Any) -> Any:
    """Matrix (3, 3) times vectors (..., 3)."""
    return (A * v[..., None, :]).sum(-1)


def matmul(A: Any, B: Any) -> Any:
    """Product of matrices (m, k) and (k, n)."""
    return (A[:, :, None] * B[None]).sum(1)


def cross(a: Any, b: Any) -> Any:
    """Vector products along the last axis, of length 3."""
    first, second = np.array([1, 2, 0]), np.array([2, 0, 1])
    return a[..., first] * b[..., second] - a[..., second] * b[..., first]


def unit(v: Any) -> Any:
    """Vectors divided by their lengths."""
    return v * dot(v, v).sqrt().inverse()[..., None]
