"""Regions of a statics log as Bernstein forms over any part of them, in whole numbers.

Every number of a log is a float, and so a whole number over a power of two. What decides is the sign of
expressions to which all coordinates contribute alike, so powers of two and binomial factors that are common
to a net are left out. Coefficients are those of Bernstein polynomials times their binomials; products of such
forms are plain convolutions.
"""

from fractions import Fraction
from math import comb
from typing import Any

import numpy as np

from .reading import Rejected, items, numbers

__all__ = ["PER_UNIT", "ExactChart", "ExactPart", "convolve", "read_chart"]

PER_UNIT = 16
"""Units of length in a metre, in which twists have their angular part."""

_HIGHEST_DEGREE = 20
# Numbers beyond these sizes make whole numbers of any length, and no object has them.
_LARGEST, _SMALLEST = 1e6, 1e-60

Net = Any
"""An array of whole numbers of any length, or of fractions."""


class ExactPart:
    """A part of a chart: (P, w) of degree (m, n) and m of degree (k, l), times binomials.

    Attributes:
        points: (m + 1, n + 1, 4) of (P, w), from the centre of mass; the point is P / w in `1 / PER_UNIT` m.
        normals: (k + 1, l + 1, 3) of a vector along the inward normal.
    """

    def __init__(self, points: Net, normals: Net):
        self.points, self.normals = points, normals


class ExactChart:
    """A chart over the unit square, by control points without binomials.

    Args:
        points: fractions (m + 1, n + 1, 4) of (P, w).
        normals: fractions (k + 1, l + 1, 3) of an inward vector; None for a patch, of which it is p_v x p_u.
    """

    def __init__(self, points: Net, normals: Net | None):
        self._points = _whole(points)
        self._normals = None if normals is None else _whole(normals)

    def over(self, u: tuple[Fraction, Fraction], v: tuple[Fraction, Fraction]) -> ExactPart:
        """The part over [u0, u1] x [v0, v1]."""
        points = _restricted(self._points, u, v)
        if self._normals is not None:
            return ExactPart(_with_binomials(points), _with_binomials(_restricted(self._normals, u, v)))
        by_u = _with_binomials(points[1:, :, :3] - points[:-1, :, :3])
        by_v = _with_binomials(points[:, 1:, :3] - points[:, :-1, :3])
        return ExactPart(_with_binomials(points), convolve(by_v, by_u, _cross))


def read_chart(data: Any, centre: Net) -> ExactChart:
    """The chart that a log describes, seen from the centre of mass (3,), fractions in m.

    Raises:
        Rejected: the data are no chart.
    """
    if isinstance(data, dict) and set(data) == {"patch"}:
        rows = [[_vector(point) for point in items(row)] for row in items(data["patch"])]
        if not 2 <= len(rows) <= _HIGHEST_DEGREE + 1 or not 2 <= len(rows[0]) <= _HIGHEST_DEGREE + 1:
            raise Rejected("a patch has no usable degree")
        if any(len(row) != len(rows[0]) for row in rows):
            raise Rejected("rows of a patch differ in length")
        net = PER_UNIT * (np.array(rows, dtype=object) - centre)
        ones = np.full((*net.shape[:2], 1), Fraction(1), dtype=object)
        return ExactChart(np.concatenate([net, ones], axis=2), None)
    if isinstance(data, dict) and set(data) == {"point", "normal"}:
        square = np.full((2, 2, 1), Fraction(1), dtype=object)
        place = np.concatenate([PER_UNIT * (_vector(data["point"]) - centre), [Fraction(1)]])
        return ExactChart(square * place, square * -_vector(data["normal"]))
    if isinstance(data, dict) and set(data) == {"sphere", "radius", "axes", "reach"}:
        return _sphere(data, centre)
    raise Rejected("a region is of no known kind")


def _sphere(data: dict[str, Any], centre: Net) -> ExactChart:
    """W = 1 + U^2 + V^2 and w n = 2 U e_1 + 2 V e_2 + (1 - U^2 - V^2) e_3, over U, V in [-reach, reach]."""
    e1, e2, e3 = (_vector(axis) for axis in items(data["axes"], 3))
    radius, s = _number(data["radius"]), _number(data["reach"])
    if not (radius >= 0 and s > 0):
        raise Rejected("a sphere has no usable radius or reach")
    linear = np.array([-s, Fraction(0), s], dtype=object)
    square = np.array([s * s, -s * s, s * s], dtype=object)
    squares = square[:, None, None] + square[None, :, None]
    outward = 2 * linear[:, None, None] * e1 + 2 * linear[None, :, None] * e2 + (1 - squares) * e3
    w = 1 + squares
    points = PER_UNIT * (w * (_vector(data["sphere"]) - centre) + radius * outward)
    return ExactChart(np.concatenate([points, w], axis=2), -outward)


def convolve(a: Net, b: Net, product: Any) -> Net:
    """The product of two forms (., ., 3), with binomials, entry by entry."""
    out = None
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            term = product(a[i, j], b)
            if out is None:
                shape = (a.shape[0] + b.shape[0] - 1, a.shape[1] + b.shape[1] - 1, *term.shape[2:])
                out = np.zeros(shape, dtype=object)
            out[i : i + b.shape[0], j : j + b.shape[1]] += term
    return out


def _cross(a: Net, b: Net) -> Net:
    """The vector product of a (3,) with each of b (., ., 3)."""
    return np.stack(
        [a[(c + 1) % 3] * b[..., (c + 2) % 3] - a[(c + 2) % 3] * b[..., (c + 1) % 3] for c in range(3)],
        axis=-1,
    )


def _restricted(net: Net, u: tuple[Fraction, Fraction], v: tuple[Fraction, Fraction]) -> Net:
    """Whole multiples of the control points over a part, all by the same factor."""
    return _along(_along(net, *u).swapaxes(0, 1), *v).swapaxes(0, 1)


def _along(net: Net, start: Fraction, end: Fraction) -> Net:
    """Control points along axis 0 over [start, end]: point p is the blossom with p arguments at the end."""
    scale = max(start.denominator, end.denominator)  # powers of two
    a, b = start.numerator * (scale // start.denominator), end.numerator * (scale // end.denominator)
    if (a, b) == (0, scale):
        return net
    rows, degree = [], len(net) - 1
    for p in range(degree + 1):
        points = net
        for step in range(degree):
            x = b if step < p else a
            points = (scale - x) * points[:-1] + x * points[1:]
        rows.append(points[0])
    return np.array(rows, dtype=object)


def _with_binomials(net: Net) -> Net:
    m, n = net.shape[0] - 1, net.shape[1] - 1
    weights = np.array([[comb(m, i) * comb(n, j) for j in range(n + 1)] for i in range(m + 1)], dtype=object)
    return weights[:, :, None] * net


def _whole(net: Net) -> Net:
    """Whole multiples of fractions whose denominators are powers of two, all by the same factor."""
    scale = max(x.denominator for x in net.ravel())
    return np.array([int(x * scale) for x in net.ravel()], dtype=object).reshape(net.shape)


def _vector(data: Any) -> Net:
    return np.array([_number(x) for x in items(data, 3)], dtype=object)


def _number(data: Any) -> Fraction:
    """A number of a log, exactly."""
    value = float(numbers([data])[0])
    if abs(value) > _LARGEST or 0.0 < abs(value) < _SMALLEST:
        raise Rejected("a number is out of range")
    return Fraction(value)
