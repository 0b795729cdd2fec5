"""The solver: contacts become polynomial equations; branch and prune isolates and certifies solutions."""

from ..workers import available_cores
from .contacts import Certificate, Configuration, ContactManifold, ContactPoint, State, search_locally
from .search import (
    Outcome,
    Progress,
    SearchOrder,
    SearchState,
    Verdict,
    begin_at,
    branch_and_prune,
    one_by_one,
)
from .statics import BestFriction, StaticsResult, best_friction, refute_balance, statics_form, why_not
from .systems import SolutionBox, SystemResult, SystemSearch, iterate_system, solve_system
from .tasks import (
    CoverBox,
    SolutionSet,
    SolveResult,
    TaskSearch,
    certify_state,
    check_task,
    iterate,
    pad_misfits,
    solve,
    solve_all,
    task_form,
)

__all__ = [
    "BestFriction",
    "Certificate",
    "Configuration",
    "ContactManifold",
    "ContactPoint",
    "CoverBox",
    "Outcome",
    "Progress",
    "SearchOrder",
    "SearchState",
    "SolutionBox",
    "SolutionSet",
    "SolveResult",
    "State",
    "StaticsResult",
    "SystemResult",
    "SystemSearch",
    "TaskSearch",
    "Verdict",
    "available_cores",
    "begin_at",
    "best_friction",
    "branch_and_prune",
    "certify_state",
    "check_task",
    "iterate",
    "iterate_system",
    "one_by_one",
    "pad_misfits",
    "refute_balance",
    "search_locally",
    "solve",
    "solve_all",
    "solve_system",
    "statics_form",
    "task_form",
    "why_not",
]
