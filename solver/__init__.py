"""The solver: contacts become polynomial equations; branch and prune isolates and certifies solutions."""

from .certify import certify_state
from .check_proof import ProofCheck, check_proof
from .configuration import Certificate, Configuration
from .contact_manifold import ContactManifold, ContactPoint
from .isolate import Isolation, IsolationVerdict, SolutionBox, isolate
from .local_search import search_locally
from .solve import Progress, SolveResult, Verdict, solve
from .state import State

__all__ = [
    "Certificate",
    "Configuration",
    "ContactManifold",
    "ContactPoint",
    "Isolation",
    "IsolationVerdict",
    "Progress",
    "ProofCheck",
    "SolutionBox",
    "SolveResult",
    "State",
    "Verdict",
    "certify_state",
    "check_proof",
    "isolate",
    "search_locally",
    "solve",
]
