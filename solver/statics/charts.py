"""Contact regions of an object as charts over the unit square, for statics in the object's frame.

A point of a region is p = P / w with P and w in Bernstein form, and m, which has the direction of the inward
normal but any length, is in Bernstein form too. A patch is one chart with w = 1. A sphere is covered by one
or two stereographic charts, a single point is a chart that is constant.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, Patch, PointRegion, Region, perpendicular

__all__ = ["UNIT_M", "Chart", "region_charts"]

UNIT_M = 0.0625
"""Unit of length of statics, about that of an object: a power of two, so that nothing is rounded by it."""

# Up to this half angle a cap is one chart, whose square reaches out to the tangent of half of it.
_LARGEST_ANGLE_RAD = 2.0
# Of that tangent, which is rounded: a larger chart is on the safe side.
_ROOM = 1.0 + 1e-12


@dataclass(frozen=True, eq=False)
class Chart:
    """Part of a region; lengths are in `UNIT_M`, from the centre of mass.

    Attributes:
        points: enclosure, lower and upper, of the control points (M + 1, N + 1, 4) of (P, w).
        normals: enclosure, lower and upper, of those (K + 1, L + 1, 3) of the inward m.
        is_patch: whether w = 1 and m = -p_u x p_v, so that m follows from the points of any part.
        data: what the log of a refutation says of it, in m and in the object's own frame.
    """

    points: tuple[Array, Array]
    normals: tuple[Array, Array]
    is_patch: bool
    data: dict[str, Any]


def region_charts(region: Region, centre: Array) -> list[Chart]:
    """Charts that together cover a region, seen from the centre of mass (3,) in m."""
    match region:
        case Patch():
            return [_patch_chart(region.patch, centre)]
        case PointRegion():
            return [_point_chart(region, centre)]
        case Cap():
            return _cap_charts(region, centre)


def _patch_chart(patch: BezierPatch, centre: Array) -> Chart:
    net = _exact(patch.control_points) - _exact(centre)
    points = np.concatenate([net / Fraction(UNIT_M), np.full((*net.shape[:2], 1), Fraction(1))], axis=2)
    normals = -patch.normal.control_points
    normals = normals / np.abs(normals).max()
    return Chart(_enclosed(points), (normals, normals), True, {"patch": patch.control_points.tolist()})


def _point_chart(region: PointRegion, centre: Array) -> Chart:
    point = np.concatenate([(_exact(region.point) - _exact(centre)) / Fraction(UNIT_M), [Fraction(1)]])
    data = {"point": np.asarray(region.point).tolist(), "normal": np.asarray(region.normal).tolist()}
    corners = np.ones((2, 2, 1), dtype=object)
    normals = _enclosed(corners * -_exact(region.normal))
    return Chart(_enclosed(corners * point), normals, False, data)


def _cap_charts(cap: Cap, centre: Array) -> list[Chart]:
    """One chart about the axis, or two about both ends of it."""
    axis = np.asarray(cap.axis, dtype=float)
    if cap.half_angle_rad <= _LARGEST_ANGLE_RAD:
        return [_sphere_chart(cap, axis, float(np.tan(0.5 * cap.half_angle_rad)) * _ROOM, centre)]
    return [_sphere_chart(cap, side * axis, _ROOM, centre) for side in (1.0, -1.0)]


def _sphere_chart(cap: Cap, axis: Array, reach: float, centre: Array) -> Chart:
    """The stereographic chart about an axis, over U, V in [-reach, reach].

    w = 1 + U^2 + V^2, and w n = 2 U e_1 + 2 V e_2 + (1 - U^2 - V^2) axis for the outward normal n.
    """
    e1, e2 = (np.asarray(e, dtype=float) for e in perpendicular(axis))
    s = Fraction(reach)
    linear, square = np.array([-s, Fraction(0), s]), np.array([s * s, -s * s, s * s])
    U, V = linear[:, None, None], linear[None, :, None]
    squares = square[:, None, None] + square[None, :, None]
    outward = 2 * U * _exact(e1) + 2 * V * _exact(e2) + (1 - squares) * _exact(axis)
    w = 1 + squares
    points = w * (_exact(cap.centre) - _exact(centre)) + Fraction(float(cap.radius)) * outward
    data = {
        "sphere": np.asarray(cap.centre).tolist(), "radius": float(cap.radius),
        "axes": [e1.tolist(), e2.tolist(), axis.tolist()], "reach": reach,
    }  # fmt: skip
    homogeneous = np.concatenate([points / Fraction(UNIT_M), w], axis=2)
    return Chart(_enclosed(homogeneous), _enclosed(-outward), False, data)


def _exact(values: Array) -> Any:
    """The same numbers as fractions."""
    values = np.asarray(values, dtype=float)
    return np.array([Fraction(float(x)) for x in values.ravel()], dtype=object).reshape(values.shape)


def _enclosed(values: Any) -> tuple[Array, Array]:
    """Floats at or below fractions, and at or above them."""
    near = np.array([float(x) for x in values.ravel()]).reshape(values.shape)
    wrong = np.array([x - Fraction(y) for x, y in zip(values.ravel(), near.ravel().tolist(), strict=True)])
    wrong = wrong.reshape(values.shape)
    lower = np.where(wrong < 0, np.nextafter(near, -np.inf), near)
    upper = np.where(wrong > 0, np.nextafter(near, np.inf), near)
    return lower, upper
