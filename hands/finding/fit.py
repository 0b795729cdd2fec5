"""Regions fitted onto the outside of a link: patches over a rectangle, and caps around its end."""

from typing import NamedTuple

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Cap, Patch, PointRegion, Shape, bernstein
from .cast import Hits, cast_onto, surface_points

__all__ = ["Frame", "fit_cap", "fit_patch", "fit_point"]

# Digits of a metre, and of a direction, that are kept: a file says just what was found.
_DIGITS = 7
_GRID = 9
_DEGREES = (1, 2, 3)
# A surface so much steeper than the patch's middle is another side.
_STEEPEST = np.cos(np.radians(50.0))
# Facets lean against the round surface that they stand for.
_MOST_LEAN = np.cos(np.radians(20.0))
# A facet that is flat, or perpendicular to its frame, within this is so but for the rounding of meshes.
_FLAT_M = 1e-6
_RAYS = 60
_RADII_M = (0.002, 0.04)


class Frame(NamedTuple):
    """Axes on a link, in its frame: where a patch lies.

    Attributes:
        point: (3,) on its middle or above it, in m.
        normal: unit vector (3,) out of the link.
        along: unit vector (3,) perpendicular to it.
    """

    point: Array
    normal: Array
    along: Array

    @property
    def across(self) -> Array:
        """The third axis: along x across = normal."""
        return np.cross(self.normal, self.along)


def _far(shapes: tuple[Shape, ...]) -> float:
    """A length in m that leads from any point of the shapes out of them."""
    return 2.0 * float(np.ptp(surface_points(shapes), axis=0).max()) + 0.01


def fit_patch(
    shapes: tuple[Shape, ...], frame: Frame, half: tuple[float, float], tolerance_m: float
) -> Patch | None:
    """A patch over the rectangle of the frame with sides 2 `half` in m, along and across.

    Returns:
        The patch of the lowest degree that stays within the tolerance of the surface; None where there is
        none, or where the surface ends or bends away.
    """
    far = _far(shapes)
    corners = np.array([[s, t] for s in (-half[0], half[0]) for t in (-half[1], half[1])])
    if not np.all(np.isfinite(_cast_down(shapes, frame, corners, far).depth)):  # most places fail here, soon
        return None
    x, y = np.meshgrid(np.linspace(-1, 1, _GRID), np.linspace(-1, 1, _GRID), indexing="ij")
    hits = _cast_down(shapes, frame, np.column_stack([half[0] * x.ravel(), half[1] * y.ravel()]), far)
    if not np.all(np.isfinite(hits.depth)) or (hits.normal @ frame.normal).min() < _STEEPEST:
        return None
    heights = (far - hits.depth).reshape(_GRID, _GRID)
    flat = _flat_patch(frame, half, heights)
    if flat is not None:
        return Patch(flat)
    t = np.linspace(0.0, 1.0, _GRID)
    for degree in _DEGREES:
        basis = bernstein(degree, t)
        inverse = np.linalg.pinv(basis)
        net = inverse @ heights @ inverse.T
        if np.abs(basis @ net @ basis.T - heights).max() <= tolerance_m:
            patch = BezierPatch(np.round(_control_points(frame, half, net), _DIGITS))
            normals = patch.unit_normal(t[:, None], t[None, :]).reshape(-1, 3)
            lean = np.einsum("ij,ij->i", normals, hits.normal)
            return Patch(patch) if lean.min() >= _MOST_LEAN else None
    return None


def _flat_patch(frame: Frame, half: tuple[float, float], heights: Array) -> BezierPatch | None:
    """The patch of a flat facet, a parallelogram that is flat to the last digit; None where there is none.

    One that is perpendicular to the frame's normal but for what meshes are rounded by is so exactly: pads of
    jaws that slide along one line are parallel then. To round control points one by one would turn them.
    """
    s = np.linspace(-1.0, 1.0, _GRID)
    mean = float(heights.mean())
    slopes = np.array([s @ heights.mean(axis=1), heights.mean(axis=0) @ s]) / (s @ s)
    if np.abs(heights - mean).max() <= _FLAT_M:
        slopes = np.zeros(2)
    elif np.abs(heights - mean - slopes[0] * s[:, None] - slopes[1] * s).max() > _FLAT_M:
        return None
    middle = np.round(frame.point + mean * frame.normal, _DIGITS)
    sides = [
        round(width, _DIGITS) * axis + slope * frame.normal
        for width, axis, slope in zip(half, (frame.along, frame.across), slopes, strict=True)
    ]
    ends = (-1.0, 1.0)
    return BezierPatch(np.array([[middle + u * sides[0] + v * sides[1] for v in ends] for u in ends]))


def _cast_down(shapes: tuple[Shape, ...], frame: Frame, places: Array, far: float) -> Hits:
    """Rays against the frame's normal, from `far` above the places (n, 2) along and across."""
    origins = frame.point + places @ np.array([frame.along, frame.across]) + far * frame.normal
    return cast_onto(shapes, origins, np.tile(-frame.normal, (len(places), 1)))


def _control_points(frame: Frame, half: tuple[float, float], net: Array) -> Array:
    steps = np.linspace(-1.0, 1.0, len(net))
    return (
        frame.point
        + half[0] * steps[:, None, None] * frame.along
        + half[1] * steps[None, :, None] * frame.across
        + net[..., None] * frame.normal
    )


def fit_cap(shapes: tuple[Shape, ...], axis: Array, half_angle_rad: float, tolerance_m: float) -> Cap | None:
    """A cap about the farthest point of a link along the unit vector `axis` (3,); None if not round."""
    points = surface_points(shapes)
    heights = points @ axis
    top = points[heights >= heights.max() - 1e-4].mean(axis=0)
    directions = _cone(axis, half_angle_rad)
    centre = top - 0.25 * float(np.ptp(points @ np.cross(axis, _least(axis)))) * axis
    far = _far(shapes)
    for _ in range(3):
        hits = cast_onto(shapes, centre + far * directions, -directions)
        if not np.all(np.isfinite(hits.depth)):
            return None
        p = centre + (far - hits.depth)[:, None] * directions
        # |p - c|^2 = r^2 as linear equations of c and r^2 - c.c.
        A = np.column_stack([2.0 * p, np.ones(len(p))])
        solution = np.linalg.lstsq(A, np.einsum("ij,ij->i", p, p), rcond=None)[0]
        centre = solution[:3]
        square = solution[3] + centre @ centre
        if not _RADII_M[0] ** 2 <= square <= _RADII_M[1] ** 2:
            return None
    radius = float(np.sqrt(square))
    hits = cast_onto(shapes, centre + far * directions, -directions)
    if not np.all(np.isfinite(hits.depth)) or np.abs(far - hits.depth - radius).max() > tolerance_m:
        return None
    if np.einsum("ij,ij->i", hits.normal, directions).min() < _MOST_LEAN:
        return None
    return Cap(np.round(centre, _DIGITS), round(radius, _DIGITS), _rounded(axis), half_angle_rad)


def fit_point(shapes: tuple[Shape, ...], frame: Frame) -> PointRegion:
    """The point of the surface at the frame's middle, with its normal; the farthest where the ray misses."""
    far = _far(shapes)
    hits = cast_onto(shapes, (frame.point + far * frame.normal)[None], -frame.normal[None])
    if np.isfinite(hits.depth[0]):
        return PointRegion(
            np.round(frame.point + (far - hits.depth[0]) * frame.normal, _DIGITS), _rounded(hits.normal[0])
        )
    points = surface_points(shapes)
    return PointRegion(np.round(points[(points @ frame.normal).argmax()], _DIGITS), _rounded(frame.normal))


def _rounded(direction: Array) -> Array:
    rounded = np.round(direction, _DIGITS)
    return np.asarray(rounded / np.linalg.norm(rounded))


def _least(axis: Array) -> Array:
    """The unit vector along the coordinate axis that `axis` is least along."""
    return np.eye(3)[np.abs(axis).argmin()]


def _cone(axis: Array, half_angle_rad: float) -> Array:
    """Unit vectors (n, 3) spread over the cap of directions about `axis`."""
    k = np.arange(_RAYS) + 0.5
    cosine = 1.0 - (1.0 - np.cos(half_angle_rad)) * k / _RAYS
    angle = np.pi * (1.0 + np.sqrt(5.0)) * k
    e1 = np.cross(axis, _least(axis))
    e1 /= np.linalg.norm(e1)
    e2 = np.cross(axis, e1)
    sine = np.sqrt(1.0 - cosine**2)
    return np.asarray(
        cosine[:, None] * axis + sine[:, None] * (np.cos(angle)[:, None] * e1 + np.sin(angle)[:, None] * e2)
    )
