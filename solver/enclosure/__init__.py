"""Functions over boxes: straight-line programs, Bernstein forms and slopes in interval arithmetic."""

from .bernstein import bernstein_range, control_points, workspace
from .native import NativeSystem, native_system
from .slopes import Expansion, centre_slopes, curvatures, values_and_slopes
from .straight_line import Enclosure, ProgramTables, StraightLineProgram, enclose

__all__ = [
    "Enclosure",
    "Expansion",
    "NativeSystem",
    "ProgramTables",
    "StraightLineProgram",
    "bernstein_range",
    "centre_slopes",
    "control_points",
    "curvatures",
    "enclose",
    "native_system",
    "values_and_slopes",
    "workspace",
]
