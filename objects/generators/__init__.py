"""Built-in objects whose shape is made by code, one module an object."""

from collections.abc import Callable

from .convex import convex_part
from .generated import GeneratedShape
from .guitar import guitar, guitar_real
from .scalpel import scalpel, scalpel_real
from .teapot import teapot

__all__ = ["GENERATORS", "GeneratedShape", "convex_part"]

GENERATORS: dict[str, Callable[[], GeneratedShape]] = {
    "guitar": guitar,
    "guitar_real": guitar_real,
    "scalpel": scalpel,
    "scalpel_real": scalpel_real,
    "teapot": teapot,
}
"""By the name that an object file gives as `generator`."""
