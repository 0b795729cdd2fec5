"""The object as MJCF: what the hand moves is the body `object`, what stays behind the body `stand`."""

import xml.etree.ElementTree as ET

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ...objects import ObjectModel, Part, TurnTest
from ...solver import Configuration
from ..settings import HoldSettings
from .body import add_inertial, add_shape
from .document import section
from .xml import element, face_text, numbers, pose_attributes, vertex_text

__all__ = [
    "OBJECT_BODY",
    "STAND_BODY",
    "add_hinge",
    "add_object",
    "add_object_classes",
    "add_sites",
    "add_stand",
]

OBJECT_BODY = "object"
STAND_BODY = "stand"
# Reflected inertia of what the hinge drives, such as a worm gear: a key of some grams alone would be lighter
# than contacts of this stiffness can bear at this time step.
_HINGE_ARMATURE = 1e-4
# MuJoCo's meshes have one colour each, so a painted surface is drawn by so many at most.
_MOST_COLOURS = 24


def add_object_classes(root: ET.Element, obj: ObjectModel, settings: HoldSettings) -> None:
    """Adds the default classes of the object: its contacts, and its looks."""
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


def add_object(root: ET.Element, obj: ObjectModel, T_palm_object: Array) -> ET.Element:
    """Adds the body `object`, without joints."""
    body = element(
        section(root, "worldbody"),
        "body",
        name=OBJECT_BODY,
        childclass=OBJECT_BODY,
        **pose_attributes(T_palm_object),
    )
    add_inertial(body, obj.inertia)
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


def add_hinge(body: ET.Element, test: TurnTest) -> None:
    """Adds the hinge of a turn to the body `object`, with its dry friction."""
    element(
        body,
        "joint",
        name=OBJECT_BODY,
        type="hinge",
        pos=numbers(test.hinge_point),
        axis=numbers(test.hinge_axis),
        frictionloss=numbers([test.friction_torque_Nm]),
        armature=numbers([_HINGE_ARMATURE]),
        # Stiff, so that dry friction holds still below its torque: with MuJoCo's 20 ms and impedance of 0.9
        # it creeps, by several degrees in a turn where no no-slip passes mend it.
        solreffriction="0.005 1",
        solimpfriction="0.9999 0.9999 0.001 0.5 2",
    )


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


def _add_part(root: ET.Element, body: ET.Element, part: Part, *, touches: bool) -> None:
    name = f"{OBJECT_BODY}/{part.name}"
    rgba = numbers(part.rgba)
    if part.paint is not None:
        for k, ((red, green, blue), vertices, faces) in enumerate(part.paint.patches(_MOST_COLOURS)):
            colour = numbers([red, green, blue, 1.0])
            _add_surface(root, body, f"{name}/paint_{k}", vertices, faces, colour)
    elif len(part.pieces) == 1:
        # One convex piece looks like the part, so it is drawn itself.
        kind = {"class_": f"{OBJECT_BODY}/collision", "group": "2"}
        if not touches:
            kind = {"class_": f"{OBJECT_BODY}/visual"}
        add_shape(root, body, f"{name}_0", part.pieces[0], rgba=rgba, **kind)
        return
    else:
        _add_surface(root, body, name, np.asarray(part.mesh.vertices), np.asarray(part.mesh.faces), rgba)
    if touches:
        for i, piece in enumerate(part.pieces):
            add_shape(root, body, f"{name}_{i}", piece, class_=f"{OBJECT_BODY}/collision", rgba=rgba)


def _add_surface(
    root: ET.Element, body: ET.Element, name: str, vertices: Array, faces: Indices, rgba: str
) -> None:
    """Adds what is seen and touches nothing."""
    mesh = element(section(root, "asset"), "mesh", name=name, inertia="shell")
    mesh.set("vertex", vertex_text(vertices))
    mesh.set("face", face_text(faces))
    element(body, "geom", name=name, class_=f"{OBJECT_BODY}/visual", type="mesh", mesh=name, rgba=rgba)
