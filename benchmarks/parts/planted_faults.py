"""Grasp files as others write them, sound or with one fault whose nature is known."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from holdfast.geometry import invert, quaternion_from_rotation
from holdfast.hands import jacobian_from_axes, joint_axes
from holdfast.pipeline.formats import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    Question,
    QuestionName,
    WrittenObject,
    WrittenPose,
)
from holdfast.pipeline.verify.reading import NearObject, States, finger_links
from holdfast.pipeline.verify.reading.hand_frames import hand_frames
from holdfast.pipeline.verify.reading.joint_orders import joint_orders
from parts.sound_grasps import Sound

READING: dict[str, QuestionName] = {
    "joint order": "joint_order",
    "quaternion order": "quaternion",
    "inverse scale": "scale",
    "millimetres": "length",
    "TCP for base": "frame",
    "degrees": "angle",
}
FINGER = {"2 mm deep": 2e-3, "2 mm off": -2e-3}
FAULTS = (*READING, *FINGER)
SCALE = 2.0
# A finger that was to be moved is where it should be to this.
_EXACT_M = 5e-4
_SETTLED: dict[QuestionName, str] = {"angle": "rad", "joint_length": "m", "direction": "hand_in_object"}
_QUESTIONS = (
    Question.of("quaternion", "wxyz"),
    Question.of("length", "m"),
    Question.of("scale", "times"),
    Question.of("frame", "base"),
    Question("joint_order", (), None),
)
_ANSWERS = {
    "quaternion order": "xyzw",
    "inverse scale": "divided",
    "millimetres": "mm",
    "TCP for base": "tcp",
    "degrees": "deg",
}


@dataclass(frozen=True, eq=False)
class Planted:
    """A file with what is wrong with it.

    Attributes:
        file: what is written.
        fault: one of `FAULTS`, or `none`.
        wanted: answers that reading it rightly takes, where they are not the usual ones.
        fingers: links that were moved, by grasp; none where the fault is one of reading.
        joints: (n, n_joints) that the file means.
    """

    file: GraspFile
    fault: str
    wanted: Mapping[QuestionName, str]
    joints: np.ndarray
    fingers: Sequence[int] = field(default_factory=tuple)


def planted(
    sounds: Sequence[Sound], fault: str, near: NearObject, rng: np.random.Generator
) -> Planted | None:
    """A file of these grasps with one fault; None where it can't be planted in them.

    Of a file with a finger that is moved, that is done to every grasp.
    """
    hand = sounds[0].task.hand
    orders = joint_orders(hand, len(hand.axes))
    order = "hand"
    if fault == "joint order":
        others = [name for name in orders if name != "hand"]
        if not others:
            return None
        order = others[int(rng.integers(len(others)))]
    revolute = np.array([axis.kind == "revolute" for axis in hand.axes])
    if fault == "degrees" and not revolute.any():
        return None
    wanted = {READING[fault]: _ANSWERS.get(fault, order)} if fault in READING else {}
    grasps, meant, fingers = [], [], []
    for i, sound in enumerate(sounds):
        joints, T = sound.configuration.joint_vector, invert(sound.configuration.state.T_palm_object)
        if fault in FINGER:
            moved = _with_finger(sound, near, FINGER[fault], rng)
            if moved is None:
                return None
            joints = moved[0]
            fingers.append(moved[1])
        meant.append(joints)
        written = np.where(revolute, np.degrees(joints), joints) if fault == "degrees" else joints
        if fault == "joint order" and np.array_equal(joints[orders[order]], joints):
            return None
        if fault == "TCP for base":
            T = T @ hand_frames(hand)["tcp"]
        q = quaternion_from_rotation(T[:3, :3])
        pose = WrittenPose(
            position=T[:3, 3] * (1e3 if fault == "millimetres" else 1.0),
            quaternion=np.roll(q, -1) if fault == "quaternion order" else q,
        )
        scale = 1.0 / SCALE if fault == "inverse scale" else SCALE
        posture = Posture(pose, JointValues(written[orders[order]]))
        grasps.append(Grasp(str(i), posture, object=WrittenObject(scale=(scale,))))
    file = GraspFile(Path("planted"), "dexgraspbench", "planted", tuple(grasps), _QUESTIONS, _SETTLED)
    return Planted(file, fault, wanted, np.array(meant), tuple(fingers))


def _with_finger(
    sound: Sound, near: NearObject, depth_m: float, rng: np.random.Generator
) -> tuple[np.ndarray, int] | None:
    """Joints that bring one contact so deep into the object, and its link; None where none do."""
    configuration, hand = sound.configuration, sound.task.hand
    origins, directions = joint_axes(hand, configuration.joint_vector)[1:]
    for k in rng.permutation(len(configuration.task.contacts)):
        link, point = configuration.task.contacts[k].hand.link, configuration.contact_points[k]
        J = jacobian_from_axes(hand, origins, directions, link, point.p_hand)[0] @ hand.coupling_matrix
        along = -point.n_object @ J
        if along @ along < 1e-6:
            continue
        q = configuration.state.q + depth_m * along / (along @ along)
        if np.any(q < hand.limits[:, 0]) or np.any(q > hand.limits[:, 1]):
            continue
        # The step is of first order, and another part of the finger may be at the object as well.
        if abs(_finger_at_m(sound, near, hand.expand(q), link) + depth_m) < _EXACT_M:
            return hand.expand(q), link
    return None


def _finger_at_m(sound: Sound, near: NearObject, joints: np.ndarray, link: int) -> float:
    """The signed distance from the object of the finger that a link is part of."""
    T = sound.configuration.state.T_palm_object
    found = near.distances(States(joints[None], T[None], np.ones((1, 3)))).distance_m[0]
    links = next(links for links in finger_links(sound.task.hand).values() if link in links)
    return float(found[links].min())
