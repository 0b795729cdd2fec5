"""Configurations of a task: distinct certified ones, all of them, or a proof that there are none."""

from .certify import TaskCertifier, certify_state
from .explain import TaskRelaxation, explain_infeasible
from .misfit import PadMisfit, pad_misfits
from .proof_form import task_form
from .search import TaskSearch
from .solution_radii import SolutionRadii, solution_radii
from .solve import SolveResult, check_task, iterate, solve
from .solve_all import CoverBox, SolutionSet, solve_all

__all__ = [
    "CoverBox",
    "PadMisfit",
    "SolutionRadii",
    "SolutionSet",
    "SolveResult",
    "TaskCertifier",
    "TaskRelaxation",
    "TaskSearch",
    "certify_state",
    "check_task",
    "explain_infeasible",
    "iterate",
    "pad_misfits",
    "solution_radii",
    "solve",
    "solve_all",
    "task_form",
]
