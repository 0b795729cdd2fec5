"""GraspIt! worlds: robots and bodies in the world's frame, in millimetres."""

import re
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from .grasp_file import (
    Grasp,
    GraspFile,
    JointValues,
    Posture,
    WrittenHand,
    WrittenObject,
    WrittenPose,
    questions,
)
from .values import as_numbers, as_quaternions, as_text

__all__ = ["read_graspit"]

FORMAT = "graspit"
_TRANSFORM = re.compile(r"\(([^()\[\]]{1,400})\)\s*\[([^()\[\]]{1,400})\]")
_MOST_BODIES = 1000
_MOST_PAIRS = 10_000


def read_graspit(world: Element, path: Path) -> GraspFile:
    """A grasp for each hand and each body that can be grasped.

    Raises:
        InputError: naming the element and what is allowed.
    """
    robots, bodies = world.findall("robot"), world.findall("graspableBody")
    if max(len(robots), len(bodies)) > _MOST_BODIES:
        raise InputError(path, "world", f"has more than {_MOST_BODIES} robots or bodies")
    for elements, name in ((robots, "robot"), (bodies, "graspableBody")):
        if not elements:
            raise InputError(path, f"world.{name}", "is required: a grasp is of a robot and a body")
    carriers = _carriers(world)
    hands = [i for i in range(len(robots)) if i not in carriers]
    if not 0 < len(hands) * len(bodies) <= _MOST_PAIRS:
        raise InputError(path, "world", f"must have 1 to {_MOST_PAIRS} pairs of a hand and a body")
    made = [(i, _hand(robots[i], path, f"robot.{i}")) for i in hands]
    grasps = tuple(
        Grasp(
            f"robot {i}, body {k}",
            posture,
            hand=hand,
            object=WrittenObject(
                name=_stem(_text(body, "filename", path, f"graspableBody.{k}")),
                path=_text(body, "filename", path, f"graspableBody.{k}"),
                frame="world",
            ),
            object_pose=_pose(body, path, f"graspableBody.{k}"),
        )
        for i, (hand, posture) in made
        for k, body in enumerate(bodies)
    )
    return GraspFile(
        path,
        FORMAT,
        "world",
        grasps,
        questions(
            quaternion="wxyz", length="mm", angle="rad", joint_length="mm", frame="base", joint_order=None
        ),
        {},
        tuple(_remarks(len(hands), len(bodies), len(carriers))),
    )


def _carriers(world: Element) -> set[int]:
    """Robots that others are mounted on: arms."""
    parents = (connection.findtext("parentRobot", "") for connection in world.findall("connection"))
    return {int(parent) for parent in parents if parent.strip().isdecimal() and len(parent) < 6}


def _hand(robot: Element, path: Path, field: str) -> tuple[WrittenHand, Posture]:
    filename = _text(robot, "filename", path, field)
    hand = WrittenHand(_stem(filename), filename, "world")
    written = robot.findtext("dofValues")
    joints = None if written is None else JointValues(_numbers(written, None, path, f"{field}.dofValues"))
    return hand, Posture(_pose(robot, path, field), joints)


def _pose(element: Element, path: Path, field: str) -> WrittenPose:
    field = f"{field}.transform.fullTransform"
    written = element.findtext("transform/fullTransform")
    if written is None:
        raise InputError(path, field, "is required")
    found = _TRANSFORM.fullmatch(written.strip())
    if not found:
        raise InputError(path, field, "must be (w x y z)[x y z]")
    quaternion = as_quaternions([_numbers(found[1], 4, path, field).tolist()], path, field)[0]
    return WrittenPose(position=_numbers(found[2], 3, path, field), quaternion=quaternion)


def _numbers(text: str, count: int | None, path: Path, field: str) -> Array:
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        raise InputError(path, field, "must be numbers") from None
    return as_numbers(np.array(values), (count,), path, field)


def _text(element: Element, name: str, path: Path, field: str) -> str:
    return as_text((element.findtext(name) or "").strip(), path, f"{field}.{name}")


def _stem(filename: str) -> str:
    return filename.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]


def _remarks(hands: int, bodies: int, carriers: int) -> list[str]:
    remarks = ["its dofValues also hold numbers of springs, mostly zeros, among those of joints"]
    if hands * bodies > 1:
        remarks.append(f"each of {hands} hands is paired with each of {bodies} bodies")
    if carriers:
        remarks.append("robots that carry others are taken for arms and left aside")
    return remarks
