"""How large a load contacts of limited normal force carry at most, whichever way gravity acts."""

from .best import BestLoad, best_load
from .point import carried_load, most_against
from .problem import LoadProblem, largest_force_N, load_form, load_problem, why_no_load
from .worker import LoadSetup

__all__ = [
    "BestLoad",
    "LoadProblem",
    "LoadSetup",
    "best_load",
    "carried_load",
    "largest_force_N",
    "load_form",
    "load_problem",
    "most_against",
    "why_no_load",
]
