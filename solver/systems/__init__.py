"""All solutions of any polynomial system in a box."""

from .file import SystemProblem, system_from_data
from .search import SystemSearch
from .solve import Isolation, IsolationProgress, IsolationVerdict, isolate, iterate_system
from .worker import SolutionBox

__all__ = [
    "Isolation",
    "IsolationProgress",
    "IsolationVerdict",
    "SolutionBox",
    "SystemProblem",
    "SystemSearch",
    "isolate",
    "iterate_system",
    "system_from_data",
]
