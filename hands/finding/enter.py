"""Where rays enter a polyhedron, compiled: there are many rays, and hulls of real links have many faces."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices

__all__ = ["enter_planes"]

# A ray along a plane meets it nowhere.
_ALONG = 1e-12


@compiled
def enter_planes(A: Array, b: Array, origins: Array, directions: Array, depth: Array, first: Indices) -> None:
    """Where rays enter the polyhedron {x: A x <= b}.

    Args:
        A: (m, 3) unit outward normals.
        b: (m,) their offsets, in m.
        origins: (n, 3) in m.
        directions: (n, 3) unit vectors.
        depth: (n,) receives the lengths at which rays enter; inf for those that miss or begin inside.
        first: (n,) receives the plane that each one enters by.
    """
    for i in range(len(origins)):
        enter, leave, plane = -np.inf, np.inf, 0
        for k in range(len(b)):
            speed = A[k, 0] * directions[i, 0] + A[k, 1] * directions[i, 1] + A[k, 2] * directions[i, 2]
            room = b[k] - (A[k, 0] * origins[i, 0] + A[k, 1] * origins[i, 1] + A[k, 2] * origins[i, 2])
            if speed < -_ALONG:
                if room / speed > enter:
                    enter, plane = room / speed, k
            elif speed > _ALONG:
                leave = min(leave, room / speed)
            elif room < 0.0:
                leave = -np.inf
            if enter > leave:
                break
        depth[i] = enter if 0.0 <= enter <= leave else np.inf
        first[i] = plane
