"""The nodes of a task as a GLB file: one for all its grasps, for they differ in poses alone."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import trimesh
from trimesh.exchange import gltf

from ...base.numeric.arrays import Array, Picture
from .task_scene import SceneNode

__all__ = ["task_glb"]

_ROUGHNESS = 0.65
# Parts of trimesh without types.
_visual: Any = trimesh.visual
_gltf: Any = gltf


def task_glb(nodes: Iterable[SceneNode]) -> bytes:
    """A GLB file with the nodes by name, every mesh in the frame of its own link or of the object."""
    scene = trimesh.Scene()
    for node in nodes:
        # A copy without what trimesh has cached: normals would double the file, and viewers make their own.
        mesh = trimesh.Trimesh(np.asarray(node.mesh.vertices), np.asarray(node.mesh.faces), process=False)
        colour = np.array(node.rgba) if node.rgb is None else np.ones(4)
        material: Any = _visual.material.PBRMaterial(
            baseColorFactor=_amounts(colour), roughnessFactor=_ROUGHNESS, metallicFactor=0.0
        )
        visual: Any = _visual.TextureVisuals(material=material)
        if node.rgb is not None:
            opaque = np.ones((len(node.rgb), 1))
            visual.vertex_attributes["color"] = _amounts(np.hstack([node.rgb / 255.0, opaque]))
        mesh.visual = visual
        scene.add_geometry(mesh, node_name=node.name, geom_name=node.name)
    data: bytes = _gltf.export_glb(scene, include_normals=False)
    return data


def _amounts(rgba: Array) -> Picture:
    """Colours (..., 4) as screens have them (sRGB) in amounts of light, as glTF wants; opacity stays."""
    found = np.array(rgba)
    shade = found[..., :3]
    found[..., :3] = np.where(shade <= 0.04045, shade / 12.92, ((shade + 0.055) / 1.055) ** 2.4)
    return np.round(255.0 * found).astype(np.uint8)
