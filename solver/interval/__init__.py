"""Outward-rounded interval arithmetic with cosine and sine, compiled; arrays of balls; boxes."""

from .arithmetic import add, div, down, mul, power, scale, sqr, sqrt_interval, sub, up
from .balls import Balls
from .box import Interval, hull, is_within
from .roots import root_interval
from .trigonometry import COSINE, SINE, trig_range

__all__ = [
    "COSINE",
    "SINE",
    "Balls",
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
