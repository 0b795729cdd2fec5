"""Where flat faces or edges touch: what they share, all of which is nearest, and its middle."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import perpendicular

__all__ = ["contact_corners", "middle_of"]

# Corners that are this near to the foremost one lie in one face or edge with it: skins give by as much.
_FLAT_M = 2.5e-4


def contact_corners(a: Array, b: Array, normal: Array, point: Array) -> Array:
    """Corners (k, 3) of what two convex bodies share where they touch, on the first one; or one point.

    Args:
        a: corners (n, 3) of the first body, or of the core of a round one.
        b: corners (m, 3) of the second.
        normal: unit vector (3,) from the first to the second.
        point: (3,) a point of the first that is nearest to the second, or deepest in it.
    """
    alone = np.asarray(point)[None]
    front_a = a[a @ normal >= (a @ normal).max() - _FLAT_M]
    front_b = b[b @ normal <= (b @ normal).min() + _FLAT_M]
    if len(front_a) < 2 or len(front_b) < 2:
        return alone  # a corner or a ball touches in one point
    axes = np.array(perpendicular(normal))
    one, other = (_around((front - point) @ axes.T) for front in (front_a, front_b))
    subject, window = (one, other) if len(one) <= len(other) else (other, one)
    if len(window) < 3:
        window = _strip(window)  # two edges, which share a point where they cross, or a length side by side
    shared = _clipped(subject, window)
    return np.asarray(point + shared @ axes) if len(shared) else alone


def middle_of(corners: Array, normal: Array) -> Array:
    """The middle (3,) of what is shared, by its extent along two axes in its plane."""
    first, axes = corners[0], np.array(perpendicular(normal))
    flat = (corners - first) @ axes.T
    return np.asarray(first + 0.5 * (flat.min(axis=0) + flat.max(axis=0)) @ axes)


def _around(points: Array) -> Array:
    """Corners (k, 2) of the hull of points (n, 2), in their order around it; a segment has two."""
    centred = points - points.mean(axis=0)
    sizes, turned = np.linalg.svd(centred, full_matrices=False)[1:]
    if sizes[1] < _FLAT_M:
        along = centred @ turned[0]
        return points[[int(along.argmin()), int(along.argmax())]]
    order = np.argsort(np.arctan2(centred[:, 1], centred[:, 0]))
    return np.asarray(points[order])


def _strip(segment: Array) -> Array:
    """The rectangle (4, 2), in its order around, of what is next to a segment (2, 2)."""
    along = segment[1] - segment[0]
    aside = _FLAT_M * np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), _FLAT_M)
    return np.array([segment[0] - aside, segment[1] - aside, segment[1] + aside, segment[0] + aside])


def _clipped(subject: Array, window: Array) -> Array:
    """What of a convex polygon or a segment lies within a convex polygon (Sutherland and Hodgman, 1974)."""
    kept = list(subject)
    for p, q in zip(window, np.roll(window, -1, axis=0), strict=True):
        inward = np.array([p[1] - q[1], q[0] - p[0]])
        corners, kept = kept, []
        for k, corner in enumerate(corners):
            before = corners[k - 1]
            here, there = float((corner - p) @ inward), float((before - p) @ inward)
            if here * there < 0.0:
                kept.append(before + (corner - before) * there / (there - here))
            if here >= 0.0:
                kept.append(corner)
    return np.array(kept).reshape(-1, 2)
