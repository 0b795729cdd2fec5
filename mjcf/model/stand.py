"""Hand and object as one MJCF model where a stand holds the object: for turns and presses.

The palm and the stand are fixed in the world. In a turn the parts that turn are the body `object`, on a hinge
`object` with dry friction, and the others the body `stand`; parts do not touch each other. In a press all of
the object is the body `object`, without a joint.
"""

import xml.etree.ElementTree as ET

import numpy as np

from ...arrays import Array
from ...objects import Task, TurnTest
from ...solver import Configuration
from ..settings import HoldSettings
from .grasp import OBJECT_BODY, STAND_BODY, add_keyframes, add_object, add_sites, add_stand, new_grasp_model
from .hand import section
from .payload import payload
from .scene import add_scene
from .xml import element, numbers, to_text

__all__ = ["stand_mjcf", "stand_tree"]

# Reflected inertia of what the hinge drives, such as a worm gear: a key of some grams alone would be lighter
# than contacts of this stiffness can bear at this time step.
_HINGE_ARMATURE = 1e-4


def stand_mjcf(
    configuration: Configuration,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
) -> str:
    """Hand, object and stand as MJCF text, without gravity, loadable by plain MuJoCo.

    Args:
        configuration: the grasp, of a task whose test is a turn or a press.
        settings: friction and solver settings; None takes the defaults.
        targets: servo targets (n_independent,) of the squeeze, in rad or m; None leaves its keyframe out.
        pregrasp: joints (n_independent,) of the open fingers; None leaves their keyframe out.

    Raises:
        InputError: a name that a model can't carry.
    """
    settings = settings or HoldSettings()
    root, body = stand_tree(configuration.task, settings, configuration.state.T_palm_object)
    add_sites(body, configuration)
    turns = isinstance(configuration.task.test, TurnTest)
    add_keyframes(root, configuration, targets, pregrasp, np.zeros(1 if turns else 0))
    return to_text(root)


def stand_tree(task: Task, settings: HoldSettings, T_palm_object: Array) -> tuple[ET.Element, ET.Element]:
    """The model of a turn or a press with the object at a pose (4, 4), and in it the body `object`."""
    root = new_grasp_model(task, settings)
    body = add_object(root, section(root, "worldbody"), payload(task, settings), T_palm_object, settings)
    if isinstance(task.test, TurnTest):
        _add_hinge(body, task.test)
        if task.obstacles:
            add_stand(root, T_palm_object, task.obstacles, touches=True)
            element(section(root, "contact"), "exclude", body1=OBJECT_BODY, body2=STAND_BODY)
    add_scene(root)
    return root, body


def _add_hinge(body: ET.Element, test: TurnTest) -> None:
    element(
        body,
        "joint",
        name=OBJECT_BODY,
        type="hinge",
        pos=numbers(test.hinge_point),
        axis=numbers(test.hinge_axis),
        frictionloss=numbers([test.friction_torque_Nm]),
        armature=numbers([_HINGE_ARMATURE]),
        # Stiff, so that dry friction holds still below its torque: with MuJoCo's 20 ms it creeps.
        solreffriction="0.005 1",
    )
