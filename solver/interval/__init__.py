"""Outward-rounded interval arithmetic with cosine and sine, compiled, and boxes."""

from .arithmetic import add, div, down, mul, power, scale, sqr, sqrt_interval, sub, up
from .box import Interval, hull, is_within
from .roots import root_interval
from .trigonometry import COSINE, SINE, trig_range

__all__ = [
    "COSINE",
    "SINE",
    "Interval",
    "add",
    "div",
    "down",
    "hull",
    "is_within",
    "mul",
    "power",
    "root_interval",
    "scale",
    "sqr",
    "sqrt_interval",
    "sub",
    "trig_range",
    "up",
]
