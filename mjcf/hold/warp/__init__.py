"""The lift in MuJoCo Warp: many grasps at once, on a GPU or, to try it, on the processor."""

from .hold_many import hold_many

__all__ = ["hold_many"]
