"""From the inputs of a task's system to a state, compiled."""

from typing import NamedTuple

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array, Indices
from ...geometry import make_rotation

__all__ = ["InputTables", "put_state"]


class InputTables(NamedTuple):
    """Where a state's parts stand among the variables of a system.

    Attributes:
        joints: (n_angles,) independent joints whose angles are inputs.
        divisors: (n_angles,) by which an angle is divided before its cosine and sine are taken.
        cosines: (n_angles,) indices.
        sines: (n_angles,) indices.
        direct: (n_direct,) independent joints whose position is an input itself: slides, and some angles.
        direct_inputs: (n_direct,) indices.
        direct_units: (n_direct,) what one is in the system, in m or rad.
        axes: (3, 3) in rows, the axes of the object in which its contacts are written.
        rotation: (6,) indices of the first two axes in the palm frame; none if the object is fixed.
        position: (3,) indices of the object's position; likewise.
        params: (n_params,) indices of the patch parameters.
        lower: (n_independent,) limits of the joints.
        upper: (n_independent,)
        unit_m: length of one in the system.
    """

    joints: Indices
    divisors: Array
    cosines: Indices
    sines: Indices
    direct: Indices
    direct_inputs: Indices
    direct_units: Array
    axes: Array
    rotation: Indices
    position: Indices
    params: Indices
    lower: Array
    upper: Array
    unit_m: float


@compiled
def put_state(t: InputTables, x: Array, q: Array, R: Array, p: Array, params: Array) -> None:
    """Fills in place what the variables `x` (n,) say; joints and parameters are clipped to their limits."""
    for k in range(len(t.joints)):
        j, divisor = t.joints[k], t.divisors[k]
        # The turn nearest to the middle of the limits, which need not lie around zero.
        middle = 0.5 * (t.lower[j] + t.upper[j]) / divisor
        turn = np.arctan2(x[t.sines[k]], x[t.cosines[k]]) - middle
        q[j] = divisor * (middle + turn - 2.0 * np.pi * np.rint(turn / (2.0 * np.pi)))
    for k in range(len(t.direct)):
        q[t.direct[k]] = x[t.direct_inputs[k]] * t.direct_units[k]
    for j in range(len(q)):
        q[j] = min(max(q[j], t.lower[j]), t.upper[j])
    for k in range(len(t.params)):
        params[k] = min(max(x[t.params[k]], 0.0), 1.0)
    if len(t.rotation):
        for a in range(3):
            R[a, 0], R[a, 1] = x[t.rotation[a]], x[t.rotation[3 + a]]
            p[a] = x[t.position[a]] * t.unit_m
        make_rotation(R)
        R[:] = R @ t.axes
