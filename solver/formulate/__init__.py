"""A task's contacts as a polynomial system in joint angles, object pose and patch parameters."""

from .angles import LIMIT_ROOM
from .formulate import Formulation, formulate
from .region_equations import UNIT_M

__all__ = ["LIMIT_ROOM", "UNIT_M", "Formulation", "formulate"]
