"""What a body of a model is made of: its mass and its shapes."""

import xml.etree.ElementTree as ET

from ...geometry import Hull, MassProperties, Shape, mujoco_geom
from .document import section
from .xml import element, numbers, vertex_text

__all__ = ["add_inertial", "add_shape"]


def add_inertial(body: ET.Element, properties: MassProperties) -> None:
    """Gives a body its mass, centre of mass and inertia."""
    I = properties.inertia  # noqa: E741  the field's symbol
    element(
        body,
        "inertial",
        pos=numbers(properties.centre),
        mass=numbers([properties.mass]),
        fullinertia=numbers([I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]]),
    )


def add_shape(root: ET.Element, body: ET.Element, name: str, shape: Shape, **attributes: str) -> None:
    """Adds a convex shape to a body as a geom, exact for all but hulls, which become mesh assets."""
    kind, values = mujoco_geom(shape)
    own = {"type": kind, **{key: numbers(value) for key, value in values.items()}}
    if isinstance(shape, Hull):
        vertices = vertex_text(shape.vertices)
        element(section(root, "asset"), "mesh", name=name, inertia="convex", vertex=vertices)
        own["mesh"] = name
    element(body, "geom", name=name, **attributes, **own)
