"""The solver: contacts become polynomial equations; branch and prune isolates and certifies solutions."""

from ..workers import available_cores
from .contacts import Certificate, Configuration, ContactManifold, ContactPoint, State, search_locally
from .search import Outcome, SearchOrder, SearchState, branch_and_prune
from .systems import (
    Isolation,
    IsolationProgress,
    IsolationVerdict,
    SolutionBox,
    SystemSearch,
    isolate,
    iterate_system,
)
from .tasks import (
    Cover,
    CoverBox,
    Progress,
    SolveResult,
    TaskSearch,
    Verdict,
    certify_state,
    iterate,
    solve,
    solve_all,
    task_form,
)

__all__ = [
    "Certificate",
    "Configuration",
    "ContactManifold",
    "ContactPoint",
    "Cover",
    "CoverBox",
    "Isolation",
    "IsolationProgress",
    "IsolationVerdict",
    "Outcome",
    "Progress",
    "SearchOrder",
    "SearchState",
    "SolutionBox",
    "SolveResult",
    "State",
    "SystemSearch",
    "TaskSearch",
    "Verdict",
    "available_cores",
    "branch_and_prune",
    "certify_state",
    "isolate",
    "iterate",
    "iterate_system",
    "search_locally",
    "solve",
    "solve_all",
    "task_form",
]
