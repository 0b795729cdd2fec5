"""The text of MJCF and URDF models: read, mended and checked before MuJoCo compiles it."""

from .mesh_files import MissingMesh
from .model_text import ModelText, read_model_text
from .surplus import without_unknown

__all__ = ["MissingMesh", "ModelText", "read_model_text", "without_unknown"]
