"""Where the object really is when the hand closes, against where the grasp has it."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import quaternion_from_rotation, rotation_from_quaternion
from ...solver import Configuration

__all__ = ["Placement", "placed"]


@dataclass(frozen=True, eq=False)
class Placement:
    """How far the object is off.

    Attributes:
        shift_m: displacement (3,) in the palm frame.
        turn: rotation (3, 3) in the palm frame, about the middle of the grasp's contact points: about a far
            centre of mass, such as a guitar's, a small turn would shift the contacts by centimetres.
    """

    shift_m: Array
    turn: Array


def placed(configuration: Configuration, pose: Array, placement: Placement | None) -> Array:
    """A pose (7,) of the object in the palm frame, position and quaternion, moved by a placement."""
    if placement is None:
        return pose
    middle = np.mean([point.p_object for point in configuration.contact_points], axis=0)
    R = placement.turn @ rotation_from_quaternion(pose[3:])
    p = middle + placement.turn @ (pose[:3] - middle) + placement.shift_m
    return np.concatenate([p, quaternion_from_rotation(R)])
