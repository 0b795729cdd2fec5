"""What is mended, or refused, in the text of a model before MuJoCo compiles it.

MuJoCo refuses bodies without mass, reads `inf` as a number, and passes over mimics of unknown joints.
"""

import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from ....base.numeric.arrays import Array
from ....errors import InputError, UnknownName
from .links import MOVING

__all__ = ["check_mimics", "check_numbers", "mend_inertials", "mend_urdf_numbers", "visuals_as_collisions"]

# Attributes that hold names, which may read like numbers.
_NAMES = re.compile(
    r"name|class|childclass|file\w*|link|parent|child|mesh|material|type|target|prefix|model|.*(joint|body|geom|site)\d?"
)
_NOT_FINITE = re.compile(r"[+-]?(inf|nan)\b", re.IGNORECASE)
# Attributes of URDF that hold several numbers, and of its shapes those that are lengths.
_LISTS = ("xyz", "rpy", "size", "scale")
_LENGTHS = {
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "box": ("size",),
}
# What weighs less (kg) is written so for other programs' sake, and weighs nothing.
_LEAST_MASS = 1e-9
# MuJoCo takes smaller moments for none (kg m^2); those of a grain of sand are larger.
_LEAST_INERTIA = 1e-13
# A stand-in until the shapes are known: the radius of gyration of a part of a finger.
_GYRATION_M = 0.01


def check_numbers(root: ET.Element, path: Path) -> None:
    """Refuses numbers that are not finite.

    Raises:
        InputError: naming the element and the attribute.
    """
    for element in root.iter():
        for key, value in element.attrib.items():
            if not _NAMES.fullmatch(key) and any(_infinite(word) for word in value.split()):
                name = element.get("name")
                where = f"{element.tag} {name}" if name else str(element.tag)
                raise InputError(path, f"{where}.{key}", f"has finite numbers alone, not {value[:80]!r}")


def _infinite(word: str) -> bool:
    if _NOT_FINITE.match(word):  # in a spelling that C reads and Python may not, such as nan(1)
        return True
    try:
        return not math.isfinite(float(word))
    except ValueError:
        return False


def mend_urdf_numbers(root: ET.Element) -> list[str]:
    """Takes commas out of lists of numbers, and shapes without extent out of links; returns what was done."""
    with_commas = [(element, key) for element in root.iter() for key in _LISTS if "," in element.get(key, "")]
    for element, key in with_commas:
        element.set(key, element.get(key, "").replace(",", " "))
    notes = [f"commas between numbers, read as spaces: {len(with_commas)}"] if with_commas else []
    empty = list[str]()
    for link in root.iter("link"):
        for solid in [child for child in link if child.tag in ("visual", "collision")]:
            shapes = [shape for geometry in solid.findall("geometry") for shape in geometry]
            if any(_is_empty(shape) for shape in shapes):
                link.remove(solid)
                empty.append(link.get("name", ""))
    if empty:
        notes.append(f"shapes without extent, left out: {', '.join(dict.fromkeys(empty))}")
    return notes


def _is_empty(shape: ET.Element) -> bool:
    """Whether a length of a shape of URDF is zero."""
    words = [word for key in _LENGTHS.get(shape.tag, ()) for word in shape.get(key, "").split()]
    try:
        return any(float(word) == 0.0 for word in words)
    except ValueError:
        return False  # which MuJoCo refuses


def check_mimics(root: ET.Element, path: Path) -> None:
    """Refuses mimics of joints that are not there or can't move; drops mimics of joints that can't move.

    Raises:
        InputError: naming the joint.
    """
    moving = [joint.get("name", "") for joint in root.findall("joint") if joint.get("type", "") in MOVING]
    for joint in root.findall("joint"):
        for mimic in joint.findall("mimic"):
            if joint.get("type") not in MOVING:
                joint.remove(mimic)
                continue
            master = mimic.get("joint", "")
            if master == joint.get("name"):
                raise InputError(path, f"joint {master}.mimic", "follows itself; another joint is allowed")
            if master not in moving:
                raise UnknownName(
                    path, f"joint {joint.get('name')}.mimic", "joint that moves", master, moving
                )
            for key in ("multiplier", "offset"):
                _number(mimic, key, path, f"joint {joint.get('name')}.mimic")


def _number(element: ET.Element, key: str, path: Path, where: str) -> float | None:
    text = element.get(key)
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        raise InputError(path, f"{where}.{key}", f"is a number, not {text[:80]!r}") from None


def visuals_as_collisions(root: ET.Element, *, is_forced: bool) -> bool:
    """Lets links of a URDF model that don't collide do so by what they draw; whether there are any.

    Args:
        root: of the model.
        is_forced: whether to do so where other links collide.
    """
    if not is_forced and next(root.iter("collision"), None) is not None:
        return False
    bare = [link for link in root.iter("link") if link.find("collision") is None]
    visuals = [visual for link in bare for visual in link.findall("visual")]
    for visual in visuals:
        visual.tag = "collision"
    return bool(visuals)


def mend_inertials(root: ET.Element, path: Path) -> tuple[set[str], list[str]]:
    """Takes away masses that no body can have, and puts stand-ins for inertias that none can have.

    Returns:
        Names of bodies whose inertia is a stand-in, and what was done, for people to read.

    Raises:
        InputError: something in place of a number.
    """
    urdf = root.tag == "robot"
    stand_ins, without = list[str](), list[str]()
    for body in list(root.iter("link" if urdf else "body")):
        name = body.get("name", "")
        for inertial in body.findall("inertial"):
            mass = _mass(inertial, path, name, urdf=urdf)
            if mass is None or mass <= _LEAST_MASS:
                body.remove(inertial)
                if mass is None or mass < 0.0:
                    without.append(name)
                continue
            inertia = _inertia(inertial, path, name, urdf=urdf)
            if inertia is None or np.linalg.eigvalsh(inertia).min() <= _LEAST_INERTIA:
                _put_inertia(inertial, mass * _GYRATION_M**2, urdf=urdf)
                stand_ins.append(name)
    notes = []
    if without:
        notes.append(f"mass missing or negative, and left out: {', '.join(without)}")
    if stand_ins:
        notes.append(f"inertia that no body has, replaced by that of the shapes: {', '.join(stand_ins)}")
    return set(stand_ins), notes


def _mass(inertial: ET.Element, path: Path, name: str, *, urdf: bool) -> float | None:
    holder = inertial.find("mass") if urdf else inertial
    key = "value" if urdf else "mass"
    return None if holder is None else _number(holder, key, path, f"{name}.inertial")


def _inertia(inertial: ET.Element, path: Path, name: str, *, urdf: bool) -> Array | None:
    """The matrix (3, 3); None where there is none."""
    keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    if urdf:
        holder = inertial.find("inertia")
        if holder is None:
            return None
        given = [_number(holder, key, path, f"{name}.inertial.inertia") or 0.0 for key in keys]
    else:
        text = inertial.get("fullinertia") or inertial.get("diaginertia")
        if text is None:
            return None
        try:
            given = [float(word) for word in text.split()]
        except ValueError:
            raise InputError(path, f"{name}.inertial", f"is made of numbers, not {text[:80]!r}") from None
        if len(given) not in (3, 6):
            raise InputError(path, f"{name}.inertial", f"has 3 or 6 moments of inertia, not {len(given)}")
        given += [0.0] * (6 - len(given))
    xx, yy, zz, xy, xz, yz = given
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _put_inertia(inertial: ET.Element, moment: float, *, urdf: bool) -> None:
    text = repr(moment)
    if urdf:
        for old in inertial.findall("inertia"):
            inertial.remove(old)
        moments = dict.fromkeys(("ixx", "iyy", "izz"), text)
        ET.SubElement(inertial, "inertia", {**moments, "ixy": "0", "ixz": "0", "iyz": "0"})
    else:
        inertial.attrib.pop("fullinertia", None)
        inertial.set("diaginertia", f"{text} {text} {text}")
