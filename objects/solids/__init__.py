"""Solid bodies: mesh files and their repair, closed patches, lofts, convex pieces, mass."""

from .closed_patches import join_patches
from .closeness import Closeness
from .decompose import Decomposition, convex_pieces
from .loft import Loft, revolve
from .mass import shell_inertia, solid_inertia
from .mesh_file import MESH_FORMATS, closed_mesh, read_mesh
from .mesh_surface import MeshSurface

__all__ = [
    "MESH_FORMATS",
    "Closeness",
    "Decomposition",
    "Loft",
    "MeshSurface",
    "closed_mesh",
    "convex_pieces",
    "join_patches",
    "read_mesh",
    "revolve",
    "shell_inertia",
    "solid_inertia",
]
