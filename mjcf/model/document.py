"""An MJCF document with its sections, to be filled."""

import xml.etree.ElementTree as ET

from .xml import element

__all__ = ["new_model", "section"]


def new_model(name: str) -> ET.Element:
    """An empty model with the sections in their usual order and the options that every model here needs."""
    root = ET.Element("mujoco", {"model": name})
    element(root, "compiler", angle="radian", autolimits="true", inertiafromgeom="false")
    # MuJoCo 4.0.0 factorises the sparse Newton Hessian wrongly with elliptic cones, so dense is asked for.
    element(root, "option", integrator="implicitfast", cone="elliptic", jacobian="dense")
    for section in ("visual", "default", "asset", "worldbody", "contact", "equality", "actuator", "keyframe"):
        element(root, section)
    return root


def section(root: ET.Element, name: str) -> ET.Element:
    """A section that `new_model` made."""
    found = root.find(name)
    assert found is not None
    return found
