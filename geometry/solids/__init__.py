"""Solid bodies: mesh files and their repair, closed patches, lofts, convex pieces, mass."""

from .carved import CarvedSolid
from .closed_patches import join_patches
from .closeness import Closeness, SurfaceDistance
from .decompose import Decomposition, convex_pieces
from .light_mesh import light_mesh
from .loft import Loft, revolve
from .mass import shell_inertia, solid_inertia
from .mesh_file import MESH_FORMATS, closed_mesh, looks_like_mesh, read_mesh
from .mesh_surface import MeshSurface
from .paint import Paint
from .paint_file import paint_files, read_paint

__all__ = [
    "MESH_FORMATS",
    "CarvedSolid",
    "Closeness",
    "Decomposition",
    "Loft",
    "MeshSurface",
    "Paint",
    "SurfaceDistance",
    "closed_mesh",
    "convex_pieces",
    "join_patches",
    "light_mesh",
    "looks_like_mesh",
    "paint_files",
    "read_mesh",
    "read_paint",
    "revolve",
    "shell_inertia",
    "solid_inertia",
]
