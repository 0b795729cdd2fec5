"""All places where a link and the object are pressed together, where their contact is no point."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import ConvexSurface, perpendicular

__all__ = ["pressed_places"]

# Places are looked for so far about the deepest one, on a grid of this width.
_REACH_M, _STEP_M = 0.012, 0.002
# Pads give by so much, and surfaces that lie this near to each other are pressed together.
_YIELD_M = 2.5e-4
# Places from where one of the surfaces is farther say nothing of the gap between them.
_SEEN_M = 2e-3
_SLOPE_M = 1e-5


def pressed_places(
    link: ConvexSurface,
    obj: ConvexSurface,
    T_object_link: Array,
    at: Array,
    inward: Array,
    distance_m: float,
) -> tuple[Array, Array]:
    """Places (k, 3) on the object, and unit normals (k, 3) into it, both in the object's frame.

    Round pads and bodies made of facets touch in a corner, though a force may be centred anywhere in the
    area over which the pad yields. The gap there is the sum of a point's distances from both surfaces, of
    which it does not matter how askew the plane lies that the points are taken from.

    Args:
        link: its surface, in its frame.
        obj: the object's, in its own.
        T_object_link: (4, 4) pose of the link in the object's frame.
        at: (3,) the place on the object where the link is nearest, or deepest.
        inward: (3,) unit normal there, from the link to the object.
        distance_m: of the surfaces there; negative where the link sinks in.
    """
    steps = np.arange(-_REACH_M, _REACH_M + 0.5 * _STEP_M, _STEP_M)
    u, v = np.array(np.meshgrid(steps, steps)).reshape(2, -1)
    round_ones = np.hypot(u, v) <= _REACH_M
    grid = at + np.column_stack([u[round_ones], v[round_ones]]) @ np.array(perpendicular(inward))
    to_object = obj.signed_distances(grid)
    to_link = link.signed_distances((grid - T_object_link[:3, 3]) @ T_object_link[:3, :3])
    seen = np.maximum(np.abs(to_object), np.abs(to_link)) < _SEEN_M
    kept = seen & (to_object + to_link <= distance_m + _YIELD_M)
    points = grid[kept]
    if not len(points):
        return at[None], inward[None]
    normals = _inward(obj, points, inward)
    return points + to_object[kept, None] * normals, normals


def _inward(obj: ConvexSurface, points: Array, inward: Array) -> Array:
    """Unit normals (k, 3) into the object at points near its surface."""
    slopes = np.column_stack(
        [
            obj.signed_distances(points + step) - obj.signed_distances(points - step)
            for step in _SLOPE_M * np.eye(3)
        ]
    )
    lengths = np.linalg.norm(slopes, axis=1, keepdims=True)
    return np.where(lengths > 0.0, -slopes / np.maximum(lengths, 1e-300), inward)
