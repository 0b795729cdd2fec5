"""Many grasps as the keyframes of one MJCF model of hand and object."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...errors import InputError
from ...mjcf.model import keyed_mjcf
from ...objects import Task
from ..records import GraspRecord, to_state

__all__ = ["keyframes_mjcf"]


def keyframes_mjcf(records: Sequence[GraspRecord], task: Task, source: str) -> str:
    """Hand and object as MJCF text, the object floating, with a keyframe `<id>` for each grasp.

    Where they are known there are also `<id>/pregrasp` with the fingers open, and `<id>/squeeze`, the grasp
    with the servos sent to where they squeeze. The world's frame is that of the palm.

    Args:
        records: of the task, at least one.
        task: what they are grasps of.
        source: the file that they come from, for messages.

    Raises:
        InputError: a record is no grasp of the task, a name that a model can't carry, or there are several
            grasps of an object that leaves a part behind, which has but one place in a model.
    """
    hand = task.hand
    if len(records) > 1 and task.carried and task.obstacles:
        raise InputError(source, "", "its object leaves a part behind, so a model holds one grasp: name it")
    keys: dict[str, tuple[Array, Array]] = {}
    states = [to_state(record, task, source) for record in records]
    for record, state in zip(records, states, strict=True):
        keys[record.id] = (state.q, state.q)
        if record.approach is not None and record.approach.waypoints:
            before = _joints(record.approach.waypoints[0], hand.independent_names)
            keys[f"{record.id}/pregrasp"] = (before, before)
        if record.hold is not None and record.hold.squeeze is not None:
            targets = _joints(record.hold.squeeze.targets, hand.independent_names)
            keys[f"{record.id}/squeeze"] = (state.q, targets)
    poses = {record.id: state.T_palm_object for record, state in zip(records, states, strict=True)}
    return keyed_mjcf(task, {name: (*key, poses[name.partition("/")[0]]) for name, key in keys.items()})


def _joints(joints: dict[str, float], names: Sequence[str]) -> Array:
    return np.array([joints[name] for name in names])
