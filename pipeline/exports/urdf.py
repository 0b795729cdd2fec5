"""A hand as a URDF model with its meshes."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Box, Capsule, Hull, Shape, Sphere, perpendicular, pose, shape_mesh
from ...hands import Axis, Hand, Link
from .angles import roll_pitch_yaw
from .obj_text import obj_text

__all__ = ["hand_urdf"]

# Of a frame between two axes at one place: nothing, which programs that simulate would refuse.
_FRAME_MASS_KG, _FRAME_INERTIA_KG_M2 = 1e-6, 1e-9
# A URDF must state speeds, and hands have none that we know of: rad/s and m/s.
_SPEED = {"revolute": 10.0, "prismatic": 1.0}


def hand_urdf(hand: Hand) -> dict[str, str]:
    """The text of each file by its path: `<hand>.urdf` and `meshes/<link>_<i>.obj`.

    Links and joints have the names and frames of the hand; one with two axes stands at the end of a link
    `<link>__<first joint>` that weighs next to nothing. Coupled joints mimic theirs. Capsules, which URDF
    does not know, collide as a cylinder and two spheres. Speeds in limits are placeholders.
    """
    root = ET.Element("robot", name=hand.name)
    # MuJoCo alone reads this: it would else merge links that don't move, and look for meshes beside the file.
    extension = ET.SubElement(ET.SubElement(root, "mujoco"), "compiler")
    extension.attrib.update(
        fusestatic="false", strippath="false", discardvisual="true", balanceinertia="false"
    )
    meshes: dict[str, str] = {}
    for link in hand.links:
        _add_joints(root, hand, link)
        _add_link(root, link, meshes)
    ET.indent(root)
    text = '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
    return {f"{hand.name}.urdf": text, **meshes}


def _add_joints(root: ET.Element, hand: Hand, link: Link) -> None:
    """The joints between a link and its parent, with a link between each two of them."""
    if link.parent < 0:
        return
    parent, T = hand.links[link.parent].name, link.T_parent_link0
    for axis in link.axes[:-1]:
        between = f"{link.name}__{axis.name}"
        _add_joint(root, axis, parent, between, T)
        _add_frame(root, between)
        parent, T = between, np.eye(4)
    if link.axes:
        _add_joint(root, link.axes[-1], parent, link.name, T)
    else:
        joint = ET.SubElement(root, "joint", name=f"{link.name}__fixed", type="fixed")
        _connect(joint, parent, link.name, T)


def _add_joint(root: ET.Element, axis: Axis, parent: str, child: str, T: Array) -> None:
    joint = ET.SubElement(root, "joint", name=axis.name, type=axis.kind)
    _connect(joint, parent, child, T)
    ET.SubElement(joint, "axis", xyz=_words(axis.direction))
    servo = axis.actuator
    ET.SubElement(
        joint,
        "limit",
        lower=repr(float(axis.lower)),
        upper=repr(float(axis.upper)),
        effort=repr(float(servo.effort if servo else 0.0)),
        velocity=repr(_SPEED[axis.kind]),
    )
    if servo is not None:
        ET.SubElement(joint, "dynamics", damping=repr(float(servo.damping)))
    if axis.coupling is not None:
        coupling = axis.coupling
        mimic = ET.SubElement(joint, "mimic", joint=coupling.master)
        mimic.attrib.update(multiplier=repr(float(coupling.ratio)), offset=repr(float(coupling.offset)))


def _connect(joint: ET.Element, parent: str, child: str, T: Array) -> None:
    _add_origin(joint, T)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)


def _add_frame(root: ET.Element, name: str) -> None:
    inertial = ET.SubElement(ET.SubElement(root, "link", name=name), "inertial")
    ET.SubElement(inertial, "mass", value=repr(_FRAME_MASS_KG))
    _add_inertia(inertial, _FRAME_INERTIA_KG_M2 * np.eye(3))


def _add_link(root: ET.Element, link: Link, meshes: dict[str, str]) -> None:
    element = ET.SubElement(root, "link", name=link.name)
    inertial = ET.SubElement(element, "inertial")
    _add_origin(inertial, pose(np.eye(3), link.inertia.centre))
    ET.SubElement(inertial, "mass", value=repr(float(link.inertia.mass)))
    _add_inertia(inertial, link.inertia.inertia)
    for i, shape in enumerate(link.shapes):
        name = f"meshes/{link.name}_{i}.obj"
        meshes[name] = obj_text(shape_mesh(shape))
        visual = ET.SubElement(element, "visual")
        _add_origin(visual, np.eye(4))
        ET.SubElement(ET.SubElement(visual, "geometry"), "mesh", filename=name)
        for kind, T, attributes in _solids(shape, name):
            collision = ET.SubElement(element, "collision")
            _add_origin(collision, T)
            ET.SubElement(ET.SubElement(collision, "geometry"), kind, attributes)


def _solids(shape: Shape, mesh: str) -> Iterable[tuple[str, Array, dict[str, str]]]:
    """What URDF knows that makes up a shape: kind, pose in the link's frame, attributes."""
    match shape:
        case Sphere():
            yield _ball(shape.centre, shape.radius)
        case Capsule():
            along = shape.end - shape.start
            length = float(np.linalg.norm(along))
            R = np.column_stack([*perpendicular(along / length), along / length])
            middle = pose(R, 0.5 * (shape.start + shape.end))
            yield "cylinder", middle, {"radius": repr(float(shape.radius)), "length": repr(length)}
            yield _ball(shape.start, shape.radius)
            yield _ball(shape.end, shape.radius)
        case Box():
            yield "box", shape.T_link_box, {"size": _words(2.0 * shape.half_extents)}
        case Hull():
            yield "mesh", np.eye(4), {"filename": mesh}


def _ball(centre: Array, radius: float) -> tuple[str, Array, dict[str, str]]:
    return "sphere", pose(np.eye(3), centre), {"radius": repr(float(radius))}


def _add_inertia(inertial: ET.Element, inertia: Array) -> None:
    values = {f"i{'xyz'[a]}{'xyz'[b]}": repr(float(inertia[a, b])) for a in range(3) for b in range(a, 3)}
    ET.SubElement(inertial, "inertia", values)


def _add_origin(element: ET.Element, T: Array) -> None:
    ET.SubElement(element, "origin", xyz=_words(T[:3, 3]), rpy=_words(roll_pitch_yaw(T[:3, :3])))


def _words(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
