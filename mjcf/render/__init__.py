"""Pictures of a grasp and films of its test, by OpenGL or by ray casting."""

from .studio import Studio

__all__ = ["Studio"]
