"""What a picture of a hand, an object, a task or a grasp shows: bodies in one frame, and named regions."""

from dataclasses import dataclass

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Region, pose
from ...hands import Hand, forward_kinematics, placed_region
from ...objects import ObjectModel, Task
from ...solver import Configuration

__all__ = ["Diagram", "Mark", "grasp_diagram", "hand_diagram", "object_diagram", "task_diagrams"]


@dataclass(frozen=True, eq=False)
class Mark:
    """A region in the picture.

    Attributes:
        label: its name.
        region: the region in the frame of the picture.
        colour: number of its colour; what belongs together has the same.
    """

    label: str
    region: Region
    colour: int


@dataclass(frozen=True, eq=False)
class Diagram:
    """What is drawn, in one frame: the palm's where there is a hand, else the object's.

    Attributes:
        title: what stands above it.
        frame: whose axes are drawn, in words.
        marks: the regions.
        hand: with its palm at the origin, if there is one.
        q: joint vector (n_joints,) of the hand; empty without one.
        object: if there is one.
        T_frame_object: (4, 4) where it is.
    """

    title: str
    frame: str
    marks: tuple[Mark, ...]
    hand: Hand | None
    q: Array
    object: ObjectModel | None
    T_frame_object: Array


def hand_diagram(hand: Hand, q_independent: Array) -> Diagram:
    """A hand with all its regions.

    Args:
        hand: the hand.
        q_independent: its posture (n_independent,).
    """
    named = [(name, region.link, region.region) for name, region in hand.regions.items()]
    return _of_hand(f"hand {hand.name}", hand, q_independent, named)


def object_diagram(obj: ObjectModel) -> Diagram:
    """An object with all its regions."""
    return _of_object(f"object {obj.name}", obj, list(obj.regions.items()))


def task_diagrams(task: Task, q_independent: Array) -> tuple[Diagram, Diagram]:
    """The hand and the object of a task, each with the regions that must touch: pairs in the same colour.

    Args:
        task: the task.
        q_independent: posture (n_independent,) in which the hand is drawn.
    """
    on_hand = [(f"{i + 1}  {c.hand.name}", c.hand.link, c.hand.region) for i, c in enumerate(task.contacts)]
    on_object = [(f"{i + 1}  {_named(c.object.name)}", c.object.region) for i, c in enumerate(task.contacts)]
    return (
        _of_hand(f"task {task.name}: hand {task.hand.name}", task.hand, q_independent, on_hand),
        _of_object(f"object {task.object.name}", task.object, on_object),
    )


def grasp_diagram(configuration: Configuration, name: str) -> Diagram:
    """A grasp: the hand at the object, with the regions that touch, pairs in the same colour.

    Args:
        configuration: where hand and object are.
        name: of the grasp.
    """
    task, state = configuration.task, configuration.state
    T_palm_link = forward_kinematics(task.hand, configuration.joint_vector)
    T_palm_object = pose(state.R_palm_object, state.p_palm_object)
    marks = []
    for i, contact in enumerate(task.contacts):
        link = placed_region(contact.hand.region, T_palm_link[contact.hand.link])
        marks.append(Mark(f"{i + 1}  {contact.hand.name}", link, i))
        held = placed_region(contact.object.region, T_palm_object)
        marks.append(Mark(f"{i + 1}  {_named(contact.object.name)}", held, i))
    return Diagram(
        f"grasp {name} of {task.name}",
        "palm",
        tuple(marks),
        task.hand,
        configuration.joint_vector,
        task.object,
        T_palm_object,
    )


def _of_hand(title: str, hand: Hand, q_independent: Array, named: list[tuple[str, int, Region]]) -> Diagram:
    q = hand.expand(q_independent)
    T_palm_link = forward_kinematics(hand, q)
    marks = (
        Mark(name, placed_region(region, T_palm_link[link]), i)
        for i, (name, link, region) in enumerate(named)
    )
    return Diagram(title, "palm", tuple(marks), hand, q, None, np.eye(4))


def _of_object(title: str, obj: ObjectModel, named: list[tuple[str, Region]]) -> Diagram:
    marks = (Mark(name, region, i) for i, (name, region) in enumerate(named))
    return Diagram(title, "object", tuple(marks), None, np.zeros(0), obj, np.eye(4))


def _named(region: str) -> str:
    """What a region of the object is called; one that stands in the task itself has no name."""
    return "object, in place" if region == "inline" else region
