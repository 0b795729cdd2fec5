"""Grasps written for other programs: their grasp files, and models of hand and object."""

from .acronym import acronym_bytes
from .dexgraspbench import dexgraspbench_bytes
from .graspgen import graspgen_bytes
from .isaac_grasp import isaac_grasp_bytes
from .keyframes import keyframes_mjcf
from .obj_text import obj_text
from .placed import PlacedGrasp, placed_grasps, placed_records
from .urdf import hand_urdf
from .usd import usd_text

__all__ = [
    "PlacedGrasp",
    "acronym_bytes",
    "dexgraspbench_bytes",
    "graspgen_bytes",
    "hand_urdf",
    "isaac_grasp_bytes",
    "keyframes_mjcf",
    "obj_text",
    "placed_grasps",
    "placed_records",
    "usd_text",
]
