"""Many grasps as the keyframes of one MJCF model of hand and object."""

from collections.abc import Sequence

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...mjcf.model import keyed_mjcf
from ...objects import Task
from ..records import GraspRecord, to_state

__all__ = ["keyframes_mjcf"]


def keyframes_mjcf(grasps: Sequence[tuple[GraspRecord, Task]], source: str) -> str:
    """Hand and object as MJCF text, the object floating, with a keyframe `<id>` for each grasp.

    Where they are known there are also `<id>/pregrasp` with the fingers open, and `<id>/squeeze`, the grasp
    with the servos sent to where they squeeze. The model begins in the first grasp, squeezed where that is
    known, and controls count from its targets there. The world's frame is that of the palm.

    Args:
        grasps: at least one, each with its task; hand and object are the same in all.
        source: the file that they come from, for messages.

    Raises:
        InputError: a record is no grasp of its task, a name that a model can't carry, or there are several
            grasps of an object that leaves a part behind, which has but one place in a model.
    """
    task = grasps[0][1]
    if len(grasps) > 1 and any(own.carried and own.obstacles for _, own in grasps):
        raise InputError(source, "", "its object leaves a part behind, so a model holds one grasp: name it")
    keys: dict[str, tuple[Array, Array, Array]] = {}
    for record, own in grasps:
        state, names = to_state(record, own, source), own.hand.independent_names
        if record.hold is not None and record.hold.squeeze is not None:
            targets = _joints(record.hold.squeeze.targets, names)
            keys[f"{record.id}/squeeze"] = (state.q, targets, state.T_palm_object)
        keys[record.id] = (state.q, state.q, state.T_palm_object)
        if record.approach is not None and record.approach.waypoints:
            before = _joints(record.approach.waypoints[0], names)
            keys[f"{record.id}/pregrasp"] = (before, before, state.T_palm_object)
    return keyed_mjcf(task, keys)


def _joints(joints: dict[str, float], names: Sequence[str]) -> Array:
    return np.array([joints[name] for name in names])
