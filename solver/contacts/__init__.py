"""Hand, object and contacts as numbers: states, the contact manifold, local search, distances."""

from .configuration import Certificate, Configuration, configurations_html
from .distance import DistinctStates, distance, spread_out
from .frames import ContactFrames, contact_frames, joint_vector
from .local_search import search_locally
from .manifold import ContactManifold, ContactPoint
from .spread import spread
from .state import State
from .tables import CAP, PATCH, ContactTables, region_params

__all__ = [
    "CAP",
    "PATCH",
    "Certificate",
    "Configuration",
    "ContactFrames",
    "ContactManifold",
    "ContactPoint",
    "ContactTables",
    "DistinctStates",
    "State",
    "configurations_html",
    "contact_frames",
    "distance",
    "joint_vector",
    "region_params",
    "search_locally",
    "spread",
    "spread_out",
]
