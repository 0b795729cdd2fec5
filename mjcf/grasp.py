"""A grasp: a configuration with the squeeze that should hold it."""

from dataclasses import dataclass

from ..solver import Configuration
from .squeeze import Squeeze

__all__ = ["Grasp"]


@dataclass(frozen=True, eq=False)
class Grasp:
    """A configuration and how to squeeze in it.

    Attributes:
        configuration: where hand and object are when the contacts just touch.
        squeeze: targets of the servos.
    """

    configuration: Configuration
    squeeze: Squeeze
