"""All solutions of any polynomial system in a box."""

from .file import SystemProblem, system_from_data
from .search import SystemSearch
from .solve import SystemResult, iterate_system, solve_system
from .worker import SolutionBox

__all__ = [
    "SolutionBox",
    "SystemProblem",
    "SystemResult",
    "SystemSearch",
    "iterate_system",
    "solve_system",
    "system_from_data",
]
