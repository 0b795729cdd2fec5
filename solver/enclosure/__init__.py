"""Functions over boxes in interval arithmetic: straight-line programs, Bernstein forms, cosines, slopes."""

from .bernstein import bernstein_range, control_points, restricted_net, workspace
from .native import NativeSystem, native_system
from .slopes import Expansion, centre_slopes, curvatures, values_and_slopes
from .straight_line import Enclosure, ProgramTables, StraightLineProgram, enclose
from .trig import trig_inputs, trig_value
from .trig_line import beside_line

__all__ = [
    "Enclosure",
    "Expansion",
    "NativeSystem",
    "ProgramTables",
    "StraightLineProgram",
    "bernstein_range",
    "beside_line",
    "centre_slopes",
    "control_points",
    "curvatures",
    "enclose",
    "native_system",
    "restricted_net",
    "trig_inputs",
    "trig_value",
    "values_and_slopes",
    "workspace",
]
