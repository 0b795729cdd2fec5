"""Whether two readings say the same of what touches: the same bodies at the same places of the object."""

import numpy as np
from scipy.spatial import cKDTree

from ....base.numeric.arrays import Array
from ....geometry import invert, transform_points
from .near_object import LinkDistances, NearObject
from .states import States

__all__ = ["SAME_TOUCH_M", "touch_alike"]

SAME_TOUCH_M = 2e-4
"""Bodies that are within this of each other are at the same place."""

# Links that are nearer to the surface than this touch it.
_TOUCHES_M = 5e-4
# A grasp of which less touches says nothing.
_LEAST = 2


def touch_alike(near: NearObject, a: States, b: States) -> bool:
    """Whether in all grasps the same bodies touch the object at the same places.

    Then the readings differ in fingers that have no part in the grasp, or as a hand with equal fingers
    differs from itself when it is turned: nothing that holds the object tells which one is meant.

    Args:
        near: hand and object.
        a: grasps in one reading.
        b: the same grasps in another.
    """
    if not np.allclose(a.factors, b.factors):
        return False
    at_a, at_b = near.distances(a), near.distances(b)
    for i in range(len(a)):
        first, second = (_touching(near, states, at, i) for states, at in ((a, at_a), (b, at_b)))
        if min(len(first), len(second)) < _LEAST:
            return False
        if not (_all_in(first, second) and _all_in(second, first)):
            return False
    return True


def _touching(near: NearObject, states: States, at: LinkDistances, i: int) -> list[Array]:
    """Corners (k, 4) in the object's frame of each link that touches in grasp i, with their radii, in m."""
    T_object_palm = invert(states.T_palm_object[i])
    found = []
    for link in np.flatnonzero(np.abs(at.distance_m[i]) < _TOUCHES_M):
        corners = near.corners(int(link))
        T = T_object_palm @ at.Ts_palm_link[i, link]
        found.append(np.column_stack([transform_points(T, corners[:, :3]), corners[:, 3]]))
    return found


def _all_in(bodies: list[Array], others: list[Array]) -> bool:
    """Whether each body is where one of the others is."""
    return all(any(_same(body, other) for other in others) for body in bodies)


def _same(a: Array, b: Array) -> bool:
    apart = max(cKDTree(a).query(b)[0].max(), cKDTree(b).query(a)[0].max())
    return bool(apart <= SAME_TOUCH_M)
