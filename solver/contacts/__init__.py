"""Hand, object and contacts as numbers: states, the contact manifold, local search, distances."""

from .configuration import Certificate, Configuration, configurations_html
from .distance import DistinctStates, distance, spread_out
from .local_search import search_locally
from .manifold import ContactManifold, ContactPoint
from .spread import spread
from .state import State

__all__ = [
    "Certificate",
    "Configuration",
    "ContactManifold",
    "ContactPoint",
    "DistinctStates",
    "State",
    "configurations_html",
    "distance",
    "search_locally",
    "spread",
    "spread_out",
]
