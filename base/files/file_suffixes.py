"""How the names of files end that come from elsewhere: of meshes and of robot models.

Here, where the command line can look without loading what reads them.
"""

__all__ = ["MESH_FORMATS", "MODEL_SUFFIXES"]

MESH_FORMATS = (".obj", ".stl", ".ply", ".glb", ".off", ".dae", ".3mf")
"""Of meshes that are read."""

MODEL_SUFFIXES = (".urdf", ".xml", ".mjcf", ".xacro", ".sdf")
"""Of models that are imported, or refused with what makes them usable."""
