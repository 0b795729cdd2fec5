"""Hand and object as one MJCF model, with the grasp as its keyframe.

In a lift the body `object` floats: what the hand carries. In a turn or a press palm and stand are fixed in
the world, and parts do not touch each other: in a turn the parts that turn are the body `object`, on a hinge
`object` with dry friction; in a press all of the object is the body `object`, without a joint.
"""

import xml.etree.ElementTree as ET

import numpy as np

from ...arrays import Array
from ...geometry import quaternion_from_rotation
from ...objects import LiftTest, Task, TurnTest
from ...solver import Configuration
from ..settings import HoldSettings
from .checks import check_configuration, checked_settings
from .document import new_model, section
from .hand import add_hand
from .object import OBJECT_BODY, STAND_BODY, add_hinge, add_object, add_object_classes, add_sites, add_stand
from .pads import add_pads
from .payload import payload
from .scene import add_scene
from .sunk_contacts import add_sunk_contacts
from .xml import check_names, element, numbers, to_text

__all__ = ["grasp_mjcf", "grasp_qpos", "task_tree", "trial_mjcf"]

_GRASP_KEY, _SQUEEZE_KEY, _PREGRASP_KEY = "grasp", "squeeze", "pregrasp"


def trial_mjcf(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
    spin_arms_m: Array | None = None,
) -> str:
    """Hand and object as the task's test has them, as MJCF text, without gravity, for plain MuJoCo.

    What the hand carries, turns or presses is the body `object` with collision geoms `object/<part>_<i>`; a
    part made of several convex pieces is drawn by a geom `object/<part>` that touches nothing. Parts that
    stay behind are the body `stand`, which touches nothing in a lift. Keyframe `grasp` is the configuration
    with the servos at rest in it; keyframe `squeeze` the same with the servos' targets moved; `pregrasp` has
    the fingers open.

    Args:
        configuration: the grasp.
        settings: friction and solver settings; None takes the defaults.
        targets: servo targets (n_independent,) of the squeeze, in rad or m; None leaves its keyframe out.
        pregrasp: joints (n_independent,) of the open fingers; None leaves their keyframe out.
        spin_arms_m: arms (n,) at which friction resists spin at the contacts (`Squeeze.spin_arms_m`); None
            for those of a usual patch.

    Raises:
        InputError: no configuration, or a name that a model can't carry.
    """
    check_configuration(configuration)
    floats = isinstance(configuration.task.test, LiftTest)
    postures = {_SQUEEZE_KEY: targets, _PREGRASP_KEY: pregrasp}
    return _document(configuration, settings, postures, spin_arms_m, floats=floats)


def grasp_mjcf(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
    spin_arms_m: Array | None = None,
) -> str:
    """As `trial_mjcf` of a lift, whatever the task's test: the object floats, as a hand may move it."""
    postures = {_SQUEEZE_KEY: targets, _PREGRASP_KEY: pregrasp}
    return _document(configuration, settings, postures, spin_arms_m, floats=True)


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


def grasp_qpos(configuration: Configuration) -> Array:
    """MuJoCo's positions (nq,) of a configuration: the joints, then the object, which floats."""
    # Links stand depth first, as MuJoCo numbers its bodies, and the object comes last.
    state = configuration.state
    q = quaternion_from_rotation(state.R_palm_object)
    return np.concatenate([configuration.joint_vector, state.p_palm_object, q])


def _document(
    configuration: Configuration,
    settings: HoldSettings | None,
    postures: dict[str, Array | None],
    spin_arms_m: Array | None,
    *,
    floats: bool,
) -> str:
    check_configuration(configuration)
    task, state = configuration.task, configuration.state
    assumed = checked_settings(settings)
    root, body = task_tree(task, assumed, state.T_palm_object, floats=floats)
    if spin_arms_m is not None:
        add_pads(root, task, assumed, spin_arms_m)
    add_sites(body, configuration)
    turns = isinstance(task.test, TurnTest)
    pose = grasp_qpos(configuration)[-7:] if floats else np.zeros(1 if turns else 0)
    for name, ctrl in {_GRASP_KEY: state.q, **postures}.items():
        if ctrl is None:
            continue
        # The squeeze begins in the grasp: only its targets differ.
        q = state.q if name == _SQUEEZE_KEY else ctrl
        key = element(section(root, "keyframe"), "key", name=name)
        key.set("qpos", numbers(np.concatenate([task.hand.expand(q), pose])))
        key.set("ctrl", numbers(ctrl))
    return to_text(root)
