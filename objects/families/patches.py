"""Contact regions on flat, round and swept surfaces, as Bezier patches."""

from math import cos, sin, tan

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Patch

__all__ = ["arc", "flat", "revolved"]


def arc(start_rad: float, end_rad: float) -> Array:
    """Control points (4, 2) of a cubic along the unit circle; over 60 degrees it leaves it by 3e-5."""
    k = 4.0 / 3.0 * tan((end_rad - start_rad) / 4.0)
    first = np.array([cos(start_rad), sin(start_rad)])
    last = np.array([cos(end_rad), sin(end_rad)])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    return np.array([first, first + k * turn @ first, last - k * turn @ last, last])


def revolved(profile: Array, start_rad: float, end_rad: float) -> Patch:
    """The part between two angles of the surface of revolution about z of a Bezier profile.

    Args:
        profile: control points (n + 1, 2) of radius and height in m, so directed that the body is on its left
            (upwards for the outside of a cylinder).
        start_rad: about z from +x.
        end_rad: larger than `start_rad`.
    """
    circle = arc(start_rad, end_rad)
    net = np.zeros((4, len(profile), 3))
    net[..., :2] = circle[:, None, :] * profile[None, :, :1]
    net[..., 2] = profile[:, 1]
    return Patch(BezierPatch(net))


def flat(corner: Array, along_u: Array, along_v: Array) -> Patch:
    """A flat patch from a corner (3,) and two sides (3,) in m; the outward normal is along_u x along_v."""
    return Patch(
        BezierPatch(np.array([[corner, corner + along_v], [corner + along_u, corner + along_u + along_v]]))
    )
