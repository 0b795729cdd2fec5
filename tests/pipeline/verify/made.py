"""Grasp files made of known grasps, sound or with a fault; shares no code with what reads them."""

from pathlib import Path

import numpy as np
from holdfast.hands import Hand, load_hand
from holdfast.objects import ObjectModel, load_object
from holdfast.pipeline.formats import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    Question,
    WrittenObject,
    WrittenPose,
)
from scipy.spatial.transform import Rotation

GRIPPER = Path(__file__).resolve().parents[3] / "examples" / "jaw"
QUESTIONS = (
    Question.of("quaternion", "wxyz"),
    Question.of("length", "m"),
    Question.of("scale", "times"),
    Question.of("frame", "base"),
    Question("joint_order", (), None),
)


def gripper() -> Hand:
    return load_hand(GRIPPER / "gripper.yaml")


def block() -> ObjectModel:
    """20 x 100 x 20 mm, long along y."""
    return load_object(GRIPPER / "block.yaml")


def file_of(
    Ts_object_hand: np.ndarray, joints: np.ndarray | None, *, scale: float | None = None, **more: object
) -> GraspFile:
    """A file as DexGraspBench's are: position, quaternion w first, joints without names."""
    grasps = []
    for i, T in enumerate(Ts_object_hand):
        q = np.roll(Rotation.from_matrix(T[:3, :3]).as_quat(), 1)
        posture = Posture(
            WrittenPose(position=T[:3, 3], quaternion=q),
            None if joints is None else JointValues(joints[i]),
        )
        written = WrittenObject(scale=None if scale is None else (scale,))
        grasps.append(Grasp(str(i), posture, object=written))
    fields = {"unsettled": QUESTIONS, "settled": {"angle": "rad", "direction": "hand_in_object"}, **more}
    return GraspFile(Path("made.npy"), "dexgraspbench", "made", tuple(grasps), **fields)  # type: ignore[arg-type]
