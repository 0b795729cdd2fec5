"""The palm's own region: where the pads look when the hand closes."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Patch
from ..hand import Hand
from .cast import cast_onto, surface_points
from .facing import Facing
from .fingers import Finger
from .fit import Frame, fit_patch

__all__ = ["find_palm"]

_TOLERANCE_M = 1e-4
_HALF_M = (0.012, 0.009, 0.006, 0.004, 0.0025)
# Places that are tried on each side of the middle, so far apart.
_STEPS, _STEP_M = 6, 0.008
# The face that is taken: normals within this of the direction to the fingers.
_SAME_FACE = np.cos(np.radians(50.0))


def find_palm(hand: Hand, facing: Facing, pads: list[tuple[Finger, Array]]) -> Patch | None:
    """A patch on the palm; None where the palm has no shapes, or no even place that the pads see.

    Args:
        hand: the hand.
        facing: what its links see.
        pads: each finger with the direction its pad looks in, in the frame of its last link.
    """
    shapes = hand.links[0].shapes
    if not shapes:
        return None
    points = surface_points(shapes)
    tips = np.array([_tips(facing, finger) for finger, _ in pads]).reshape(-1, 3)
    hits = np.concatenate(
        [facing.seen(f.last, 0.5 * (f.start_m + f.end_m) * f.along, n, f.own)[1] for f, n in pads]
    )
    middle = tips.mean(axis=0)
    out = hits[:, 3:].mean(axis=0) if len(hits) else middle - points.mean(axis=0)
    if np.linalg.norm(out) < 1e-6:
        return None
    out = out / np.linalg.norm(out)
    goal = hits[:, :3].mean(axis=0) if len(hits) else middle
    normal = _face(hand, out, goal)
    if normal is None:
        return None
    return _place(hand, normal, goal)


def _tips(facing: Facing, finger: Finger) -> Array:
    T = facing.poses[:, finger.last]
    return np.asarray(T[:, :3, :3] @ (finger.end_m * finger.along) + T[:, :3, 3])


def _grid(hand: Hand, normal: Array, goal: Array) -> tuple[Array, Array, Array]:
    """Places around the goal on the plane across the normal, the nearest first; with the two axes."""
    along = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    steps = _STEP_M * np.arange(-_STEPS, _STEPS + 1)
    x, y = (a.ravel() for a in np.meshgrid(steps, steps, indexing="ij"))
    order = np.argsort(np.hypot(x, y), kind="stable")
    return goal + np.outer(x[order], along) + np.outer(y[order], across), along, across


def _face(hand: Hand, out: Array, goal: Array) -> Array | None:
    """Mean normal (3,) of the palm's face that looks to `out`."""
    shapes = hand.links[0].shapes
    places, _, _ = _grid(hand, out, goal)
    far = 2.0 * float(np.ptp(surface_points(shapes), axis=0).max()) + 0.1
    hits = cast_onto(shapes, places + far * out, np.tile(-out, (len(places), 1)))
    normals = hits.normal[np.isfinite(hits.depth)]
    normals = normals[normals @ out > _SAME_FACE]
    if not len(normals):
        return None
    # The most common normal, not the mean: a palm has a flat side more often than a round one.
    best = normals[((normals @ normals.T) > np.cos(np.radians(10.0))).sum(axis=1).argmax()]
    near = normals[normals @ best > np.cos(np.radians(10.0))].mean(axis=0)
    return np.asarray(near / np.linalg.norm(near))


def _place(hand: Hand, normal: Array, goal: Array) -> Patch | None:
    shapes = hand.links[0].shapes
    places, along, _ = _grid(hand, normal, goal)
    for half in _HALF_M:
        for place in places:
            patch = fit_patch(shapes, Frame(place, normal, along), (half, half), _TOLERANCE_M)
            if patch is not None:
                return patch
    return None
