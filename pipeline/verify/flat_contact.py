"""Where flat faces or edges touch: the middle of what they share, all of which is nearest."""

import numpy as np

from ...arrays import Array
from ...geometry import perpendicular

__all__ = ["middle_of_contact"]

# Corners that are this near to the foremost one lie in one face or edge with it.
_FLAT_M = 1e-4


def middle_of_contact(a: Array, b: Array, normal: Array, point: Array) -> Array:
    """The middle (3,) of where two convex bodies touch, on the first one.

    Args:
        a: corners (n, 3) of the first body, or of the core of a round one.
        b: corners (m, 3) of the second.
        normal: unit vector (3,) from the first to the second.
        point: (3,) a point of the first that is nearest to the second, or deepest in it.
    """
    front_a = a[a @ normal >= (a @ normal).max() - _FLAT_M]
    front_b = b[b @ normal <= (b @ normal).min() + _FLAT_M]
    if len(front_a) < 2 or len(front_b) < 2:
        return point  # a corner or a ball touches in one point
    axes = np.array(perpendicular(normal))
    one, other = (_around((front - point) @ axes.T) for front in (front_a, front_b))
    subject, window = (one, other) if len(one) <= len(other) else (other, one)
    if len(window) < 3:
        return point  # two edges that cross
    shared = _clipped(subject, window)
    if not len(shared):
        return point
    return np.asarray(point + 0.5 * (shared.min(axis=0) + shared.max(axis=0)) @ axes)


def _around(points: Array) -> Array:
    """Corners (k, 2) of the hull of points (n, 2), in their order around it; a segment has two."""
    centred = points - points.mean(axis=0)
    sizes, turned = np.linalg.svd(centred, full_matrices=False)[1:]
    if sizes[1] < _FLAT_M:
        along = centred @ turned[0]
        return points[[int(along.argmin()), int(along.argmax())]]
    order = np.argsort(np.arctan2(centred[:, 1], centred[:, 0]))
    return np.asarray(points[order])


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
