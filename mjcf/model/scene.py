"""How a model is lit and what is behind it."""

import xml.etree.ElementTree as ET

from .document import section
from .xml import element

__all__ = ["add_scene"]


def add_scene(root: ET.Element) -> None:
    """Adds light, background and picture quality to a model made by `new_model`."""
    visual, asset, world = (section(root, name) for name in ("visual", "asset", "worldbody"))
    element(visual, "global", fovy="30", offwidth="1920", offheight="1440")
    element(visual, "headlight", ambient="0.40 0.40 0.40", diffuse="0.22 0.22 0.22", specular="0 0 0")
    element(visual, "quality", shadowsize="4096", offsamples="8")
    element(visual, "map", znear="0.01", zfar="20")
    element(
        asset,
        "texture",
        name="sky",
        type="skybox",
        builtin="gradient",
        rgb1="0.93 0.945 0.96",
        rgb2="1 1 1",
        width="64",
        height="384",
    )
    element(
        world,
        "light",
        name="lamp",
        pos="0.6 0.5 1.2",
        dir="-0.45 -0.35 -0.8",
        type="spot",
        cutoff="60",
        ambient="0 0 0",
        diffuse="0.52 0.52 0.52",
        specular="0.08 0.08 0.08",
    )
