"""A point in the space of configurations, which need not satisfy anything yet."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import pose

__all__ = ["State"]


@dataclass(frozen=True, eq=False)
class State:
    """Joints, pose of the object and contact parameters.

    Attributes:
        q: independent joints (n_independent,), rad or m.
        R_palm_object: rotation (3, 3).
        p_palm_object: position (3,) in m.
        params: (n_params,) parameters in [0, 1] of the Bezier patches, contact by contact, hand side first.
    """

    q: Array
    R_palm_object: Array
    p_palm_object: Array
    params: Array

    def __post_init__(self) -> None:
        for name in ("q", "R_palm_object", "p_palm_object", "params"):
            array = np.array(getattr(self, name), dtype=float, order="C")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def T_palm_object(self) -> Array:
        """Pose (4, 4) of the object in the palm frame."""
        return pose(self.R_palm_object, self.p_palm_object)

    def copies(self) -> tuple[Array, Array, Array, Array]:
        """Joints, rotation, position and parameters, for compiled code to change."""
        return self.q.copy(), self.R_palm_object.copy(), self.p_palm_object.copy(), self.params.copy()
