"""Hand and object as one MJCF model, with the grasp as its keyframe.

In a lift the body `object` floats: what the hand carries. In a turn or a press palm and stand are fixed in
the world, and parts do not touch each other: in a turn the parts that turn are the body `object`, on a hinge
`object` with dry friction; in a press all of the object is the body `object`, without a joint.
"""

import xml.etree.ElementTree as ET
from collections.abc import Mapping

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import quaternion_from_rotation
from ...objects import LiftTest, Task, TurnTest
from ...solver import Configuration
from ..settings import HoldSettings
from .checks import check_configuration, checked_settings
from .compiled import compiled_model
from .document import section
from .object import add_sites
from .pads import add_pads, set_pads
from .pressed_pads import PressedPads
from .start import begin_in, squeeze_at_zero, weigh_in
from .tree import task_tree
from .xml import check_names, element, numbers, to_text

__all__ = ["grasp_mjcf", "grasp_qpos", "keyed_mjcf", "trial_mjcf"]

_GRASP_KEY, _SQUEEZE_KEY, _PREGRASP_KEY = "grasp", "squeeze", "pregrasp"


def trial_mjcf(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
    pads: PressedPads | None = None,
) -> str:
    """Hand and object as the task's test has them, as MJCF text, without gravity, for plain MuJoCo.

    What the hand carries, turns or presses is the body `object` with collision geoms `object/<part>_<i>`; a
    part made of several convex pieces is drawn by a geom `object/<part>` that touches nothing. Parts that
    stay behind are the body `stand`, which touches nothing in a lift. The model begins in the grasp, and its
    controls count from the targets of the squeeze (without one, of the grasp): loaded and stepped it
    squeezes. Keyframe `squeeze` is this beginning; keyframe `grasp` is the configuration with the servos at
    rest in it; `pregrasp` has the fingers open.

    Args:
        configuration: the grasp.
        settings: friction and solver settings; None takes the defaults.
        targets: servo targets (n_independent,) of the squeeze, in rad or m; None leaves its keyframe out.
        pregrasp: joints (n_independent,) of the open fingers; None leaves their keyframe out.
        pads: at the contacts of the squeeze; None for contacts of which no force is known.

    Raises:
        InputError: no configuration, or a name that a model can't carry.
    """
    check_configuration(configuration)
    floats = isinstance(configuration.task.test, LiftTest)
    postures = {_SQUEEZE_KEY: targets, _PREGRASP_KEY: pregrasp}
    return _document(configuration, settings, postures, pads, floats=floats)


def grasp_mjcf(
    configuration: Configuration,
    *,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
    pads: PressedPads | None = None,
) -> str:
    """As `trial_mjcf` of a lift, whatever the task's test: the object floats, as a hand may move it."""
    postures = {_SQUEEZE_KEY: targets, _PREGRASP_KEY: pregrasp}
    return _document(configuration, settings, postures, pads, floats=True)


def keyed_mjcf(task: Task, keys: Mapping[str, tuple[Array, Array, Array]]) -> str:
    """Hand and floating object as MJCF text, with a keyframe for each of many postures.

    The model begins in the first one, and controls count from its servo targets.

    Args:
        task: its hand and object.
        keys: by the keyframe's name, positions and servo targets (n_independent,) of the joints and the pose
            (4, 4) of the object in the palm's frame; at least one.

    Raises:
        InputError: a name that a model can't carry.
    """
    check_names(keys, source=task.name, kind="keyframe")
    q_first, zero, T_first = next(iter(keys.values()))
    root, _ = task_tree(task, checked_settings(None), T_first, floats=True)
    begin_in(root, task.hand, task.hand.expand(q_first))
    squeeze_at_zero(root, task.hand, zero)
    for name, (q, ctrl, T) in keys.items():
        free = np.concatenate([T[:3, 3], quaternion_from_rotation(T[:3, :3])])
        key = element(section(root, "keyframe"), "key", name=name)
        key.set("qpos", numbers(np.concatenate([task.hand.expand(q), free])))
        key.set("ctrl", numbers(ctrl - zero))
    return to_text(root)


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
    pads: PressedPads | None,
    *,
    floats: bool,
) -> str:
    check_configuration(configuration)
    task, state = configuration.task, configuration.state
    assumed = checked_settings(settings)
    root, body = task_tree(task, assumed, state.T_palm_object, floats=floats)
    squeeze = postures[_SQUEEZE_KEY]
    zero = state.q if squeeze is None else squeeze
    begin_in(root, task.hand, configuration.joint_vector)
    squeeze_at_zero(root, task.hand, zero)
    if pads is not None:
        _write_pads(root, configuration, assumed, pads)
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
        key.set("ctrl", numbers(ctrl - zero))
    return to_text(root)


def _write_pads(
    root: ET.Element, configuration: Configuration, settings: HoldSettings, pads: PressedPads
) -> None:
    """Adds the pads of a squeeze to a model's text; their stiffness is that where the model begins."""
    floats = root.find(".//freejoint") is not None
    model = compiled_model(configuration.task, settings, floats=floats)
    weigh_in(model, configuration.joint_vector)
    set_pads(model, configuration.task, settings, pads)
    add_pads(root, model, configuration.task.hand)
