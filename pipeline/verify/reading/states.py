"""Hands at objects as numbers: what a reading makes of the grasps of a file."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....base.numeric.arrays import Array

__all__ = ["States"]


@dataclass(frozen=True, eq=False)
class States:
    """Grasps in metres and radians, coupled joints as they were written.

    Attributes:
        joints: positions (n, n_joints) of all joints of the hand.
        T_palm_object: (n, 4, 4) poses of the object in the palm frame.
        factors: (n, 3) what the object's mesh is multiplied by along its axes.
    """

    joints: Array
    T_palm_object: Array
    factors: Array

    def __len__(self) -> int:
        return len(self.joints)

    def only(self, rows: Array) -> "States":
        """Some of them."""
        return States(self.joints[rows], self.T_palm_object[rows], self.factors[rows])

    @classmethod
    def joined(cls, several: Sequence["States"]) -> "States":
        """All of them, in their order."""
        return cls(*(np.concatenate([getattr(states, name) for states in several]) for name in _FIELDS))

    def places(self, *, reach_m: float, angle_m: float) -> Array:
        """Numbers (k,) in m by whose differences two readings of the same grasps differ.

        Args:
            reach_m: size of the object as it was loaded: what a turn or a factor moves its surface by.
            angle_m: what a radian of a joint, or a metre of a slide, counts as.
        """
        size_m = reach_m * max(1.0, float(self.factors.max(initial=1.0)))
        T = self.T_palm_object
        parts = (angle_m * self.joints, T[:, :3, 3], size_m * T[:, :3, :3], reach_m * self.factors)
        return np.concatenate([part.ravel() for part in parts])


_FIELDS = ("joints", "T_palm_object", "factors")
