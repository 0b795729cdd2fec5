"""Grasps as every writer takes them: in m and rad, the hand in the object's frame, joints by name."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import invert, pose, rotation_from_quaternion
from ...hands import Hand
from ..formats import Grasp, GraspFile, Posture, QuestionName, hand_in_object, object_factor, said_to_hold
from ..records import GraspRecord

__all__ = ["PlacedGrasp", "one_object", "placed_grasps", "placed_records"]


@dataclass(frozen=True, eq=False)
class PlacedGrasp:
    """A grasp ready to be written.

    Attributes:
        name: unique in its file.
        T_object_hand: pose (4, 4) of the hand's root link in the frame of the object, m.
        hand: name of the hand, or path of its model.
        object: name of the object, or path of its mesh.
        scale: what the object's mesh is multiplied by, so that it is in m.
        joints: of the grasp by name, coupled ones too where they are known; empty without any.
        pregrasp: the same before the fingers close; None where that isn't known.
        squeeze: the same that the servos are sent to; None where that isn't known.
        holds: whether it was found to hold; None where that isn't known.
    """

    name: str
    T_object_hand: Array
    hand: str
    object: str
    scale: float = 1.0
    joints: Mapping[str, float] = field(default_factory=dict)
    pregrasp: Mapping[str, float] | None = None
    squeeze: Mapping[str, float] | None = None
    holds: bool | None = None


def placed_records(records: Sequence[GraspRecord], hand: Hand, object_name: str) -> list[PlacedGrasp]:
    """Grasps of ours, whose records hold the object's pose in the palm's frame.

    Args:
        records: of one task.
        hand: the task's, which moves coupled joints with the others.
        object_name: the object's name or the path of its mesh, which is in its own frame and in m.
    """
    placed = []
    for record in records:
        R = rotation_from_quaternion(np.array(record.object.quaternion))
        T_palm_object = pose(R, np.array(record.object.position))
        before = record.approach.waypoints[0] if record.approach and record.approach.waypoints else None
        squeeze = None if record.hold is None or record.hold.squeeze is None else record.hold.squeeze.targets
        placed.append(
            PlacedGrasp(
                record.id,
                invert(T_palm_object),
                hand.name,
                object_name,
                joints=_all_joints(record.joints, hand, record.joints),
                pregrasp=None if before is None else _all_joints(before, hand, record.joints),
                squeeze=None if squeeze is None else _all_joints(squeeze, hand, record.joints),
                holds=None if record.hold is None else record.is_held,
            )
        )
    return placed


def _all_joints(some: Mapping[str, float], hand: Hand, otherwise: Mapping[str, float]) -> dict[str, float]:
    """Joints in the hand's order, the coupled ones moved by theirs."""
    q = np.array([some.get(name, otherwise[name]) for name in hand.independent_names])
    return dict(zip(hand.joint_names, hand.expand(q).tolist(), strict=True))


def placed_grasps(file: GraspFile, reading: Mapping[QuestionName, str]) -> list[PlacedGrasp]:
    """Grasps of a file, in a reading of it.

    Raises:
        InputError: it leaves open what no reading is given for, or its joints have no names.
    """
    for question in file.unsettled:
        if question.answers and question.name not in reading:
            answers = " or ".join(question.answers)
            raise InputError(file.path, question.name, f"is open: say by --reading whether it is {answers}")
    return [
        _placed(grasp, holds, reading, file.path)
        for grasp, holds in zip(file.grasps, said_to_hold(file), strict=True)
    ]


def _placed(grasp: Grasp, holds: bool | None, reading: Mapping[QuestionName, str], path: Path) -> PlacedGrasp:
    if grasp.grasp.pose is None:
        raise InputError(path, grasp.name, "has no pose of the hand, only joints")
    factors = object_factor(grasp, reading)
    if np.ptp(factors) > 1e-9 * factors.max():
        raise InputError(path, grasp.name, "has an object that is scaled differently along x, y and z")
    return PlacedGrasp(
        grasp.name,
        hand_in_object(grasp, reading),
        grasp.hand.name or grasp.hand.path or grasp.hand.frame,
        grasp.object.path or grasp.object.name,
        float(factors[0]),
        _joints(grasp.grasp, reading) or {},
        None if grasp.pregrasp is None else _joints(grasp.pregrasp, reading),
        None if grasp.squeeze is None else _joints(grasp.squeeze, reading),
        holds,
    )


def _joints(posture: Posture, reading: Mapping[QuestionName, str]) -> dict[str, float] | None:
    """Joints by name, those of an array called joint_0, joint_1, ...; all are taken for angles, in rad."""
    if posture.joints is None:
        return None
    values = posture.joints.values
    if reading.get("angle") == "deg":
        values = np.deg2rad(values)
    names = posture.joints.names or tuple(f"joint_{i}" for i in range(len(values)))
    return dict(zip(names, values.tolist(), strict=True))


def one_object(grasps: Sequence[PlacedGrasp], format_: str) -> PlacedGrasp:
    """The first grasp, which says for all of a file what hand and object they have.

    Raises:
        InputError: there is none, or they have several.
    """
    if not grasps:
        raise InputError("export", "", "there are no grasps to write")
    things = {(grasp.hand, grasp.object, grasp.scale) for grasp in grasps}
    if len(things) > 1:
        raise InputError(
            "export",
            format_,
            f"a file has one hand and one object of one size, but the grasps have {len(things)}",
        )
    return grasps[0]
