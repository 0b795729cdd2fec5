"""The solver: contacts become polynomial equations; branch and prune isolates and certifies solutions."""

from .certify import certify_state
from .check_proof import ProofCheck, check_proof
from .configuration import Certificate, Configuration
from .contact_manifold import ContactManifold, ContactPoint
from .cover import Cover, CoverBox, solve_all
from .isolate import Isolation, IsolationProgress, IsolationVerdict, SolutionBox, isolate, iterate_system
from .local_search import search_locally
from .search import Outcome, SearchOrder, SearchState, branch_and_prune
from .solve import Progress, SolveResult, Verdict, iterate, solve
from .state import State
from .system_search import SystemSearch
from .task_search import TaskSearch
from .workers import available_cores

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
    "ProofCheck",
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
    "check_proof",
    "isolate",
    "iterate",
    "iterate_system",
    "search_locally",
    "solve",
    "solve_all",
]
