"""Hands at objects as numbers: what a reading makes of the grasps of a file."""

from dataclasses import dataclass

import numpy as np

from ....arrays import Array

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

    def equal(self, other: "States", *, within_m: float, within_rad: float, reach_m: float) -> bool:
        """Whether the same grasps are meant: joints, poses and sizes hardly differ.

        Args:
            other: as many grasps.
            within_m: difference of places that counts as none.
            within_rad: the same of joints.
            reach_m: size of the object, by which differences of rotations and factors count as places.
        """
        turned = np.abs(self.T_palm_object[:, :3, :3] - other.T_palm_object[:, :3, :3]).max(initial=0.0)
        moved = np.abs(self.T_palm_object[:, :3, 3] - other.T_palm_object[:, :3, 3]).max(initial=0.0)
        grown = np.abs(self.factors - other.factors).max(initial=0.0)
        bent = np.abs(self.joints - other.joints).max(initial=0.0)
        return bool(
            bent <= within_rad
            and moved <= within_m
            and turned * reach_m <= within_m
            and grown * reach_m <= within_m
        )
