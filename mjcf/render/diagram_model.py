"""A diagram as a MuJoCo model: pale bodies, regions as coloured sheets with arrows along their normals."""

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import trimesh

from ...geometry import perpendicular, pose
from ..model import (
    add_hand,
    add_object,
    add_object_classes,
    add_scene,
    element,
    new_model,
    numbers,
    section,
    to_text,
)
from ..settings import HoldSettings
from .diagram import Diagram, Mark
from .labels import colour_of
from .region_mesh import region_sheet
from .views import drawn_corners

__all__ = ["diagram_model"]

# Lengths of what stands for a region, in sizes of what is drawn.
_LIFT, _ARROW_LENGTH, _ARROW_RADIUS, _HEAD = 0.002, 0.09, 0.0022, 0.024
_SIDES = 24
_REGION_GROUP = 1
# How far colours of bodies go towards this grey, so that regions stand out.
_PALER, _PALE = 0.6, 0.92


def diagram_model(diagram: Diagram) -> tuple[Any, Any, float]:
    """MuJoCo's model and data of what is drawn, and its size: the diagonal of a box around the bodies, in m.

    Raises:
        InputError: a name that a model can't carry.
    """
    model, data = _compiled(_bodies(diagram), diagram)
    corners = np.concatenate(list(drawn_corners(model, data).values()))
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    root = _bodies(diagram)
    for i, mark in enumerate(diagram.marks):
        _add_mark(root, i, mark, size)
    model, data = _compiled(root, diagram)
    # MuJoCo takes depths and shadows from these.
    model.stat.center[:], model.stat.extent = corners.mean(axis=0), size
    model.light_castshadow[:] = 0
    bodies = model.geom_group != _REGION_GROUP
    model.geom_rgba[bodies, :3] += _PALER * (_PALE - model.geom_rgba[bodies, :3])
    return model, data, size


def _bodies(diagram: Diagram) -> ET.Element:
    root = new_model("diagram")
    if diagram.hand is not None:
        add_hand(root, diagram.hand, compensate_weight=True)
    if diagram.object is not None:
        add_object_classes(root, diagram.object, HoldSettings())
        add_object(root, diagram.object, diagram.T_frame_object)
    add_scene(root)
    return root


def _compiled(root: ET.Element, diagram: Diagram) -> tuple[Any, Any]:
    import mujoco  # late, as in `hold.simulation`

    model = mujoco.MjModel.from_xml_string(to_text(root))
    data = mujoco.MjData(model)
    data.qpos[:] = diagram.q
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return model, data


def _add_mark(root: ET.Element, number: int, mark: Mark, size: float) -> None:
    rgba = numbers([*(c / 255.0 for c in colour_of(mark.colour)), 1.0])
    name = f"region/{number}"
    _add_mesh(root, name, region_sheet(mark.region, _LIFT * size), rgba)
    point, normal = mark.region.middle()
    # Shaft and head as meshes, so that nothing but their colour differs from the sheet's.
    radius, neck = _ARROW_RADIUS * size, (_ARROW_LENGTH - _HEAD) * size
    shaft = trimesh.creation.cylinder(radius=radius, height=neck, sections=_SIDES)
    shaft.apply_translation([0.0, 0.0, 0.5 * neck])
    head = trimesh.creation.cone(radius=3.0 * radius, height=_HEAD * size, sections=_SIDES)
    head.apply_translation([0.0, 0.0, neck])
    for part, mesh in (("shaft", shaft), ("head", head)):
        mesh.apply_transform(pose(np.column_stack([*perpendicular(normal), normal]), point))
        _add_mesh(root, f"{name}/{part}", mesh, rgba)


def _add_mesh(root: ET.Element, name: str, mesh: trimesh.Trimesh, rgba: str) -> None:
    asset = element(section(root, "asset"), "mesh", name=name, inertia="shell")
    asset.set("vertex", numbers(mesh.vertices, digits=9))
    asset.set("face", " ".join(str(int(i)) for i in np.ravel(mesh.faces)))
    look = {"group": str(_REGION_GROUP), "contype": "0", "conaffinity": "0", "mass": "0", "rgba": rgba}
    element(section(root, "worldbody"), "geom", name=name, type="mesh", mesh=name, **look)
