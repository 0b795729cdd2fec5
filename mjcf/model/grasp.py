"""Hand and object as one MJCF model, with the grasp as its keyframe."""

import xml.etree.ElementTree as ET

import numpy as np

from ...arrays import Array
from ...geometry import quaternion_from_rotation
from ...objects import ObjectModel, Part, Task
from ...solver import Configuration
from ..settings import HoldSettings
from .hand import add_hand, add_shape, new_model, section
from .payload import payload
from .scene import add_scene
from .xml import check_names, element, numbers, pose_attributes, to_text

__all__ = [
    "GRASP_KEY",
    "OBJECT_BODY",
    "PREGRASP_KEY",
    "SQUEEZE_KEY",
    "STAND_BODY",
    "add_keyframes",
    "add_object",
    "add_sites",
    "add_stand",
    "grasp_mjcf",
    "grasp_qpos",
    "lift_tree",
    "new_grasp_model",
]

OBJECT_BODY = "object"
STAND_BODY = "stand"
GRASP_KEY = "grasp"
SQUEEZE_KEY = "squeeze"
PREGRASP_KEY = "pregrasp"


def grasp_mjcf(
    configuration: Configuration,
    settings: HoldSettings | None = None,
    targets: Array | None = None,
    pregrasp: Array | None = None,
) -> str:
    """Hand, object and grasp as MJCF text, without gravity, loadable by plain MuJoCo.

    What the hand carries is the free body `object` with collision geoms `object/<part>_<i>`; a part made of
    several convex pieces is drawn by a geom `object/<part>` that touches nothing. Parts that stay behind are
    drawn in the body `stand` and touch nothing. Keyframe `grasp` is the configuration with the servos at rest
    in it; keyframe `squeeze` the same with the servos' targets moved; `pregrasp` has the fingers open.

    Args:
        configuration: the grasp.
        settings: friction and solver settings; None takes the defaults.
        targets: servo targets (n_independent,) of the squeeze, in rad or m; None leaves its keyframe out.
        pregrasp: joints (n_independent,) of the open fingers; None leaves their keyframe out.

    Raises:
        InputError: a name that a model can't carry.
    """
    settings = settings or HoldSettings()
    root, body = lift_tree(configuration.task, settings, configuration.state.T_palm_object)
    add_sites(body, configuration)
    add_keyframes(root, configuration, targets, pregrasp, grasp_qpos(configuration)[-7:])
    return to_text(root)


def lift_tree(task: Task, settings: HoldSettings, T_palm_object: Array) -> tuple[ET.Element, ET.Element]:
    """The model of a lift with the object at a pose (4, 4), and in it the body `object`."""
    root = new_grasp_model(task, settings)
    body = add_object(root, section(root, "worldbody"), payload(task, settings), T_palm_object, settings)
    element(body, "freejoint", name=OBJECT_BODY)
    if task.carried and task.obstacles:
        add_stand(root, T_palm_object, task.obstacles, touches=False)
    add_scene(root)
    return root, body


def new_grasp_model(task: Task, settings: HoldSettings) -> ET.Element:
    """A model with the options of the settings, and the hand."""
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
    _add_object_classes(root, task.object, settings)
    return root


def grasp_qpos(configuration: Configuration) -> Array:
    """MuJoCo's positions (nq,) of a configuration: the joints, then the object, which floats."""
    # Links stand depth first, as MuJoCo numbers its bodies, and the object comes last.
    state = configuration.state
    q = quaternion_from_rotation(state.R_palm_object)
    return np.concatenate([configuration.joint_vector, state.p_palm_object, q])


def add_keyframes(
    root: ET.Element,
    configuration: Configuration,
    targets: Array | None,
    pregrasp: Array | None,
    pose: Array,
) -> None:
    """Adds the keyframes that are given; `pose` are the positions of the object's own joints, if any."""
    q, hand = configuration.state.q, configuration.task.hand
    keys = [(GRASP_KEY, q, q), (SQUEEZE_KEY, q, targets), (PREGRASP_KEY, pregrasp, pregrasp)]
    for name, at, ctrl in keys:
        if at is None or ctrl is None:
            continue
        key = element(section(root, "keyframe"), "key", name=name)
        key.set("qpos", numbers(np.concatenate([hand.expand(at), pose])))
        key.set("ctrl", numbers(ctrl))


def _add_object_classes(root: ET.Element, obj: ObjectModel, settings: HoldSettings) -> None:
    mu = settings.sliding_friction(obj)
    top = element(section(root, "default"), "default", class_=OBJECT_BODY)
    # Of two geoms with unequal priority the higher one's values hold: the hand's own friction doesn't matter.
    element(
        top,
        "geom",
        priority="1",
        condim="4",
        friction=numbers([mu, settings.torsional_friction(obj), 0.0001]),
        solref=numbers(settings.contact_solref),
        solimp=numbers(settings.contact_solimp),
    )
    drawn = element(top, "default", class_=f"{OBJECT_BODY}/visual")
    element(drawn, "geom", group="2", contype="0", conaffinity="0", mass="0")
    element(element(top, "default", class_=f"{OBJECT_BODY}/collision"), "geom", group="3")


def add_object(
    root: ET.Element, parent: ET.Element, obj: ObjectModel, T_palm_object: Array, settings: HoldSettings
) -> ET.Element:
    """Adds the body `object` below `parent`, without joints."""
    body = element(parent, "body", name=OBJECT_BODY, childclass=OBJECT_BODY, **pose_attributes(T_palm_object))
    I = obj.inertia.inertia  # noqa: E741  the field's symbol
    element(
        body,
        "inertial",
        pos=numbers(obj.inertia.centre),
        mass=numbers([obj.inertia.mass]),
        fullinertia=numbers([I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]),
    )
    for part in obj.parts:
        _add_part(root, body, part, touches=True)
    return body


def add_stand(
    root: ET.Element, T_palm_object: Array, parts: tuple[Part, ...], *, touches: bool
) -> ET.Element:
    """Adds the body `stand`, the parts that stay where they are, in the object's frame."""
    # A mocap body can't move either, but pictures of another configuration can put it elsewhere.
    body = element(
        section(root, "worldbody"),
        "body",
        name=STAND_BODY,
        childclass=OBJECT_BODY,
        mocap="true",
        **pose_attributes(T_palm_object),
    )
    for part in parts:
        _add_part(root, body, part, touches=touches)
    return body


def _add_part(root: ET.Element, body: ET.Element, part: Part, *, touches: bool) -> None:
    name = f"{OBJECT_BODY}/{part.name}"
    rgba = numbers(part.rgba)
    if len(part.pieces) == 1:
        # One convex piece looks like the part, so it is drawn itself.
        kind = {"class_": f"{OBJECT_BODY}/collision", "group": "2"}
        if not touches:
            kind = {"class_": f"{OBJECT_BODY}/visual"}
        add_shape(root, body, f"{name}_0", part.pieces[0], rgba=rgba, **kind)
        return
    mesh = element(section(root, "asset"), "mesh", name=name, inertia="shell")
    mesh.set("vertex", numbers(part.mesh.vertices, digits=9))
    mesh.set("face", " ".join(str(int(i)) for i in np.ravel(part.mesh.faces)))
    element(body, "geom", name=name, class_=f"{OBJECT_BODY}/visual", type="mesh", mesh=name, rgba=rgba)
    if touches:
        for i, piece in enumerate(part.pieces):
            add_shape(root, body, f"{name}_{i}", piece, class_=f"{OBJECT_BODY}/collision", rgba=rgba)


def add_sites(body: ET.Element, configuration: Configuration) -> None:
    """Marks the contacts on the object, as sites `contact/<i>` with z along the object's outward normal."""
    state = configuration.state
    for i, point in enumerate(configuration.contact_points):
        p = state.R_palm_object.T @ (point.p_object - state.p_palm_object)
        n = state.R_palm_object.T @ point.n_object
        element(
            body,
            "site",
            name=f"contact/{i}",
            pos=numbers(p),
            zaxis=numbers(n),
            size="0.002",
            rgba="0.85 0.20 0.15 1",
            group="4",
        )
