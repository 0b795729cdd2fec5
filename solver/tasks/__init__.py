"""Configurations of a task: distinct certified ones, all of them, or a proof that there are none."""

from .certify import certify_state
from .cover import Cover, CoverBox, solve_all
from .explain import Relaxation, explain_infeasible
from .proof_form import task_form
from .search import TaskSearch
from .solve import Progress, SolveResult, Verdict, iterate, solve

__all__ = [
    "Cover",
    "CoverBox",
    "Progress",
    "Relaxation",
    "SolveResult",
    "TaskSearch",
    "Verdict",
    "certify_state",
    "explain_infeasible",
    "iterate",
    "solve",
    "solve_all",
    "task_form",
]
