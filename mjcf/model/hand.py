"""The hand as an MJCF model, written from the same `Hand` that the solver uses.

Bodies are called after the links, joints and actuators after the axes, geoms `<link>/<i>`. The palm is fixed
in the world, so the palm frame is the world frame. Distal joints that are coupled mechanically become
equality constraints: under 30 N at the tip a coupled distal of the SA hand yields 0.008 deg with the stiff
values below, and 0.03 deg with an impedance that starts at 0.995.
"""

import xml.etree.ElementTree as ET

from ...geometry import Shape, Sphere
from ...hands import Actuator, Axis, Hand, Link
from ...retraction import overlapping_links
from .body import add_inertial, add_shape
from .document import new_model, section
from .xml import check_names, element, numbers, pose_attributes, to_text

__all__ = ["add_hand", "hand_mjcf", "shape_rgba"]

# Colours by default class.
_RGBA = {
    "hand/palm": (0.36, 0.37, 0.40, 1.0),
    "hand/link_even": (0.84, 0.84, 0.82, 1.0),
    "hand/link_odd": (0.70, 0.71, 0.73, 1.0),
    "hand/tip": (0.20, 0.21, 0.23, 1.0),
}
# Inertia in kg m^2 and damping in N m s/rad of a joint that another one drives: small, but a link of some
# grams would otherwise be all that stands behind its stiff equality.
_COUPLED_ARMATURE = 1e-4
_COUPLED_DAMPING = 0.01


def hand_mjcf(hand: Hand) -> str:
    """The hand alone as MJCF text, loadable by plain MuJoCo.

    Raises:
        InputError: a name that a model can't carry.
    """
    root = new_model(hand.name)
    add_hand(root, hand, compensate_weight=False)
    return to_text(root)


def shape_rgba(hand: Hand, link: Link, shape: Shape) -> tuple[float, float, float, float]:
    """The colour of a shape of a link."""
    return _RGBA[_look(hand, link, shape)]


def add_hand(root: ET.Element, hand: Hand, *, compensate_weight: bool) -> None:
    """Adds the hand to a model made by `new_model`.

    Raises:
        InputError: a name that a model can't carry.
    """
    check_names((link.name for link in hand.links), source=hand.name, kind="link")
    check_names(hand.joint_names, source=hand.name, kind="joint")
    classes = _add_defaults(section(root, "default"), hand)
    bodies: list[ET.Element] = []
    for link in hand.links:
        parent = bodies[link.parent] if link.parent >= 0 else section(root, "worldbody")
        bodies.append(_add_link(root, parent, hand, link, classes, compensate_weight))
        if link.parent >= 0:
            # MuJoCo leaves out parent and child by itself, except below a body that can't move, as the palm.
            element(section(root, "contact"), "exclude", body1=hand.links[link.parent].name, body2=link.name)
    for a, b in sorted(overlapping_links(hand)):
        # What overlaps by construction would press itself apart, and clearance leaves it out too.
        if hand.links[b].parent != a:
            element(section(root, "contact"), "exclude", body1=hand.links[a].name, body2=hand.links[b].name)
    _add_drives(root, hand, classes)


def _add_defaults(default: ET.Element, hand: Hand) -> dict[Actuator, str]:
    """Writes the default classes; returns the class of each kind of servo."""
    top = element(default, "default", class_="hand")
    element(top, "geom", group="2", condim="4")
    # Distals follow within 0.01 deg under 30 N at the tip at these values, and with the armature below.
    element(top, "equality", solref="0.005 1", solimp="0.9995 0.9995 0.001 0.5 2")
    coupled = element(top, "default", class_="hand/coupled")
    element(coupled, "joint", armature=numbers([_COUPLED_ARMATURE]), damping=numbers([_COUPLED_DAMPING]))
    for name, rgba in _RGBA.items():
        element(element(top, "default", class_=name), "geom", rgba=numbers(rgba))
    servos = dict.fromkeys(axis.actuator for axis in hand.axes if axis.actuator is not None)
    classes = {servo: f"hand/servo_{i}" for i, servo in enumerate(servos)}
    for servo, name in classes.items():
        own = element(top, "default", class_=name)
        element(own, "joint", damping=numbers([servo.damping]), armature=numbers([servo.armature]))
        element(
            own, "position", kp=numbers([servo.stiffness]), forcerange=numbers([-servo.effort, servo.effort])
        )
    return classes


def _add_link(
    root: ET.Element,
    parent: ET.Element,
    hand: Hand,
    link: Link,
    classes: dict[Actuator, str],
    compensate_weight: bool,
) -> ET.Element:
    body = element(parent, "body", name=link.name, **pose_attributes(link.T_parent_link0))
    if link.parent < 0:
        body.set("childclass", "hand")
    if compensate_weight:
        body.set("gravcomp", "1")
    add_inertial(body, link.inertia)
    for axis in link.axes:
        _add_joint(body, axis, classes)
    for i, shape in enumerate(link.shapes):
        add_shape(root, body, f"{link.name}/{i}", shape, class_=_look(hand, link, shape))
    return body


def _look(hand: Hand, link: Link, shape: Shape) -> str:
    """The default class that colours a shape; neighbours along a finger differ."""
    if link.parent < 0:
        return "hand/palm"
    is_last = all(hand.links[other.parent] is not link for other in hand.links if other.parent >= 0)
    if is_last and isinstance(shape, Sphere):
        return "hand/tip"
    depth, at = 0, link
    while at.parent >= 0:
        depth, at = depth + 1, hand.links[at.parent]
    return "hand/link_even" if depth % 2 == 0 else "hand/link_odd"


def _add_joint(body: ET.Element, axis: Axis, classes: dict[Actuator, str]) -> None:
    joint = element(
        body,
        "joint",
        name=axis.name,
        type="hinge" if axis.kind == "revolute" else "slide",
        axis=numbers(axis.direction),
        range=numbers([axis.lower, axis.upper]),
    )
    joint.set("class", "hand/coupled" if axis.actuator is None else classes[axis.actuator])


def _add_drives(root: ET.Element, hand: Hand, classes: dict[Actuator, str]) -> None:
    for axis in hand.axes:
        if axis.coupling is not None:
            element(
                section(root, "equality"),
                "joint",
                name=axis.name,
                class_="hand",
                joint1=axis.name,
                joint2=axis.coupling.master,
                polycoef=numbers([axis.coupling.offset, axis.coupling.ratio, 0, 0, 0]),
            )
        if axis.actuator is not None:
            # A target may lie beyond the joint's stop: that is how a servo presses at the stop.
            reach = axis.actuator.effort / axis.actuator.stiffness
            element(
                section(root, "actuator"),
                "position",
                name=axis.name,
                class_=classes[axis.actuator],
                joint=axis.name,
                ctrlrange=numbers([axis.lower - reach, axis.upper + reach]),
            )
