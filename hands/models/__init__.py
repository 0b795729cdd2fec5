"""Hands from MJCF and URDF models; whoever imports this room imports MuJoCo."""

from .file import ImportedHandFile
from .importer import import_hand, import_model

__all__ = ["ImportedHandFile", "import_hand", "import_model"]
