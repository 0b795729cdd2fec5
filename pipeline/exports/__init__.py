"""Grasps written for other programs: their grasp files, and models of hand and object."""

from .acronym import acronym_bytes
from .bare import bare_bytes
from .dexgraspbench import dexgraspbench_bytes
from .dexgraspnet import dexgraspnet_bytes
from .formats import GRASP_FORMATS, ONE_EACH, grasp_files
from .graspgen import graspgen_bytes
from .isaac_grasp import isaac_grasp_bytes
from .keyframes import keyframes_mjcf
from .multigripper import multigripper_bytes
from .obj_text import obj_text
from .placed import PlacedGrasp, placed_grasps, placed_records
from .urdf import hand_urdf
from .usd import usd_text

__all__ = [
    "GRASP_FORMATS",
    "ONE_EACH",
    "PlacedGrasp",
    "acronym_bytes",
    "bare_bytes",
    "dexgraspbench_bytes",
    "dexgraspnet_bytes",
    "grasp_files",
    "graspgen_bytes",
    "hand_urdf",
    "isaac_grasp_bytes",
    "keyframes_mjcf",
    "multigripper_bytes",
    "obj_text",
    "placed_grasps",
    "placed_records",
    "usd_text",
]
