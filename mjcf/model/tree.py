"""The model of a task as a tree of elements, to be posed, written or compiled."""

import xml.etree.ElementTree as ET

from ...base.numeric.arrays import Array
from ...objects import Task, TurnTest
from ..settings import HoldSettings
from .document import new_model, section
from .hand import add_hand
from .object import OBJECT_BODY, STAND_BODY, add_hinge, add_object, add_object_classes, add_stand
from .payload import payload
from .scene import add_scene
from .sunk_contacts import add_sunk_contacts
from .xml import check_names, element, numbers

__all__ = ["task_tree"]


def task_tree(
    task: Task, settings: HoldSettings, T_palm_object: Array, *, floats: bool
) -> tuple[ET.Element, ET.Element]:
    """The model of a task with the object at a pose (4, 4), and in it the body `object`.

    Args:
        task: the task.
        settings: friction, masses and solver settings.
        T_palm_object: where the object is.
        floats: whether the object floats, or is as a stand holds it in the task's turn or press.
    """
    check_names((part.name for part in task.object.parts), source=task.object.name, kind="part")
    root = new_model(f"{task.hand.name} {task.name}")
    section(root, "option").attrib.update(
        timestep=numbers([settings.timestep_s]),
        gravity="0 0 0",
        impratio=numbers([settings.impratio]),
        noslip_iterations=str(settings.noslip_iterations),
        solver=settings.solver,
    )
    add_hand(root, task.hand, compensate_weight=not settings.hand_weight)
    add_object_classes(root, task.object, settings)
    body = add_object(root, payload(task, settings), T_palm_object)
    if floats:
        element(body, "freejoint", name=OBJECT_BODY)
    elif isinstance(task.test, TurnTest):
        add_hinge(body, task.test)
    if task.carried and task.obstacles:
        add_stand(root, T_palm_object, task.obstacles, touches=not floats)
        if not floats:
            element(section(root, "contact"), "exclude", body1=OBJECT_BODY, body2=STAND_BODY)
    touching = task.carried if task.carried and floats else task.object.parts
    add_sunk_contacts(root, task, touching, settings)
    add_scene(root)
    return root, body
