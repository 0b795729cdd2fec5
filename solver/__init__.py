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
from .systems import SolutionBox, SystemResult, SystemSearch, iterate_system, solve_system
from .tasks import (
    CoverBox,
    SolutionRadii,
    SolutionSet,
    SolveResult,
    TaskSearch,
    certify_state,
    iterate,
    pad_misfits,
    solution_radii,
    solve,
    solve_all,
    task_form,
)

__all__ = [
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
    "SolutionRadii",
    "SolutionSet",
    "SolveResult",
    "State",
    "SystemResult",
    "SystemSearch",
    "TaskSearch",
    "Verdict",
    "available_cores",
    "begin_at",
    "branch_and_prune",
    "certify_state",
    "iterate",
    "iterate_system",
    "one_by_one",
    "pad_misfits",
    "search_locally",
    "solution_radii",
    "solve",
    "solve_all",
    "solve_system",
    "task_form",
]
