"""Hand, object and contacts as numbers: states, the contact manifold, local search, distances."""

from .configuration import Certificate, Configuration, configurations_html
from .distinct import DistinctStates
from .local_search import search_locally
from .manifold import ContactManifold, ContactPoint
from .spread import distance, spread, spread_out
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
