"""Axes that are parallel but for the decimals of the file that they come from, made parallel.

Models write pi/2 as 1.5708 or 1.570796, so that axes which a maker machines parallel come out some 1e-7 rad
apart. The solver adds up the angles of parallel axes, which a deviation no gauge could find would prevent.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...base.numeric.arrays import Array
from ..hand import Axis, Link

__all__ = ["with_parallel_axes"]

# Axes nearer to parallel than this (rad) are meant to be; at a hand's length it moves a fingertip by 0.1 um.
_MEANT = 1e-6
# Nearer ones are parallel to rounding.
_EXACT = 1e-13


def with_parallel_axes(links: Sequence[Link]) -> tuple[list[Link], list[str]]:
    """The links with axes within 1e-6 rad of parallel made parallel, and a note that says so, if any were.

    Directions are compared in the palm's frame with all joints at zero. An axis follows the palm's own axes
    first, then those before it; only its direction changes.
    """
    known = list(np.eye(3))
    rotations: list[Array] = []
    out, turned_rad = [], []
    for link in links:
        R = link.T_parent_link0[:3, :3]
        R = R if link.parent < 0 else rotations[link.parent] @ R
        rotations.append(R)
        axes: list[Axis] = []
        for axis in link.axes:
            direction = R @ axis.direction
            angle, like = min(((_sine(direction, other), k) for k, other in enumerate(known)))
            if angle > _MEANT:
                known.append(direction / np.linalg.norm(direction))
            elif angle > _EXACT:
                turned_rad.append(angle)
                local = R.T @ (known[like] * np.sign(known[like] @ direction))
                axis = replace(axis, direction=local / np.linalg.norm(local))
            axes.append(axis)
        out.append(replace(link, axes=tuple(axes)))
    if not turned_rad:
        return out, []
    what = "1 axis" if len(turned_rad) == 1 else f"{len(turned_rad)} axes"
    return out, [f"{what} within {max(turned_rad):.1e} rad of parallel to another one, made parallel to it"]


def _sine(a: Array, b: Array) -> float:
    return float(np.linalg.norm(np.cross(a, b)) / np.linalg.norm(a))
