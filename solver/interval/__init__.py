"""Outward-rounded interval arithmetic, compiled."""

from .arithmetic import add, div, down, jit, mul, power, scale, sqr, sqrt_interval, sub, up
from .roots import root_interval

__all__ = [
    "add",
    "div",
    "down",
    "jit",
    "mul",
    "power",
    "root_interval",
    "scale",
    "sqr",
    "sqrt_interval",
    "sub",
    "up",
]
