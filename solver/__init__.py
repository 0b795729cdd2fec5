"""The solver: contacts become polynomial equations; branch and prune isolates and certifies solutions."""

from .certify import certify_state
from .configuration import Certificate, Configuration
from .contact_manifold import ContactManifold, ContactPoint
from .solve import Progress, SolveResult, Verdict, solve
from .state import State

__all__ = [
    "Certificate",
    "Configuration",
    "ContactManifold",
    "ContactPoint",
    "Progress",
    "SolveResult",
    "State",
    "Verdict",
    "certify_state",
    "solve",
]
