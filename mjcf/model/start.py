"""A model that begins in a posture: what MuJoCo shows and steps before any keyframe is asked for.

A joint's `ref` is its position where the model begins, and poses of bodies in the text are those there. So
each link is written where the posture has it, its axes turned along, and positions keep their meaning: zero
is still the hand's own zero. MuJoCo begins with all controls at zero, so there the servos squeeze.
"""

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import axis_rotation
from ...hands import Axis, Hand
from .document import section
from .xml import numbers, pose_attributes

__all__ = ["begin_in", "squeeze_at_zero", "weigh_in"]


def begin_in(root: ET.Element, hand: Hand, q: Array) -> None:
    """Makes a model of `add_hand` begin at the joint vector `q` (n_joints,).

    Couplings are kept: in MuJoCo they are between ways from where the joints begin.
    """
    bodies = {body.get("name"): body for body in root.iter("body")}
    position = dict(zip(hand.joint_names, q.tolist(), strict=True))
    for link in hand.links:
        body = bodies[link.name]
        T = link.T_parent_link0.copy()
        for axis in link.axes:
            T = T @ _moved(axis, position[axis.name])
        for name in ("pos", "quat"):
            body.attrib.pop(name, None)
        body.attrib.update(pose_attributes(T))
        turned = np.eye(3)  # from a joint's own frame to that of the whole link
        for axis in reversed(link.axes):
            joint = next(joint for joint in body.findall("joint") if joint.get("name") == axis.name)
            joint.set("axis", numbers(turned.T @ axis.direction))
            joint.set("ref", numbers([position[axis.name]]))
            turned = _moved(axis, position[axis.name])[:3, :3] @ turned
    _shift_couplings(root, hand, position)


def squeeze_at_zero(root: ET.Element, hand: Hand, targets: Array) -> None:
    """Makes a model's controls count from the servo targets (n_independent,), in rad or m.

    A servo pushes kp * (target - q), with the target at its control plus `targets`: kp * `targets` becomes
    part of its bias. So a model that is loaded and stepped, with controls at zero, squeezes.
    """
    drives = section(root, "actuator")
    drives.insert(0, ET.Comment(" ctrl: how far a servo's target lies off the one in its bias, in rad or m "))
    servos = {servo.get("name"): servo for servo in drives.findall("position")}
    position = dict(zip(hand.independent_names, targets.tolist(), strict=True))
    for axis in hand.axes:
        if axis.actuator is None:
            continue
        servo, kp, target = servos[axis.name], axis.actuator.stiffness, position[axis.name]
        servo.tag = "general"  # its class still says that of a position servo but this bias
        servo.set("biasprm", numbers([kp * target, -kp, 0.0]))
        servo.set("ctrlrange", numbers([float(end) - target for end in servo.attrib["ctrlrange"].split()]))


def weigh_in(model: Any, q: Array) -> None:
    """Gives a compiled model the inverse masses that it would have if it began at the joint vector `q`.

    MuJoCo takes the stiffness of contacts from them, and a bent finger is not as heavy as a straight one.
    """
    import mujoco  # late, as in `hold.simulation`

    data = mujoco.MjData(model)
    data.qpos[: len(q)] = q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_factorM(model, data)
    J = np.zeros((3, model.nv))
    for body in range(1, model.nbody):
        mujoco.mj_jacBodyCom(model, data, J, None, body)
        if not J.any():  # it can't move, and its inverse mass stays zero
            continue
        moved = np.zeros_like(J)
        mujoco.mj_solveM(model, data, moved, J)
        model.body_invweight0[body, 0] = float(np.trace(J @ moved.T)) / 3.0


def _moved(axis: Axis, q: float) -> Array:
    """What a joint at `q` does: a pose (4, 4) in the frame before it."""
    T = np.eye(4)
    if axis.kind == "revolute":
        T[:3, :3] = axis_rotation(axis.direction, q)
    else:
        T[:3, 3] = q * axis.direction
    return T


def _shift_couplings(root: ET.Element, hand: Hand, position: dict[str, float]) -> None:
    """MuJoCo's polynomial of a coupling maps the master's way from its start to that of the joint."""
    couplings = {axis.name: axis.coupling for link in hand.links for axis in link.axes if axis.coupling}
    for entry in section(root, "equality").findall("joint"):
        name = entry.get("name", "")
        coupling = couplings[name]
        off = coupling.offset + coupling.ratio * position[coupling.master] - position[name]
        entry.set("polycoef", numbers([off, coupling.ratio, 0, 0, 0]))
