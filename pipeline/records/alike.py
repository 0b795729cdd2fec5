"""Which grasps are different ones: climbs that end at the same top make a grasp more than once."""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import rotation_from_quaternion
from .grasp import GraspRecord

__all__ = ["different"]

# Alike are grasps whose places of object and contacts, and whose joints and turns of it, differ by no more.
_ALIKE_M, _ALIKE_RAD = 1e-3, 0.01


def different(grasps: Sequence[GraspRecord]) -> list[GraspRecord]:
    """Of grasps of one task those that are like no earlier one, in their order."""
    if not grasps:
        return []
    kept: list[int] = []
    features = np.array([_features(grasp) for grasp in grasps])
    for i, feature in enumerate(features):
        if not (np.abs(features[kept] - feature) <= 1.0).all(axis=1).any():
            kept.append(i)
    return [grasps[i] for i in kept]


def _features(grasp: GraspRecord) -> Array:
    """Numbers that differ by more than 1 where grasps are different."""
    pose = grasp.object
    places = [pose.position, *(contact.point for contact in grasp.contacts)]
    joints = np.array(list(grasp.joints.values()))
    R = rotation_from_quaternion(np.array(pose.quaternion))
    return np.concatenate([np.ravel(places) / _ALIKE_M, joints / _ALIKE_RAD, R.ravel() / _ALIKE_RAD])
