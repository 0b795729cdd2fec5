"""A local search: from any state to one where all contacts, caps and limits of a task hold, or to nothing."""

import numpy as np

from .contact_manifold import ContactManifold
from .state import State

__all__ = ["search_locally"]

# How far inside a cap the search aims, in terms of the cosine: solutions on the very edge are of little use.
_CAP_ROOM = 0.01
# An error of a cap's cosine weighs as much as this many metres.
_CAP_WEIGHT_M = 0.05


def search_locally(manifold: ContactManifold, start: State, *, max_steps: int = 40) -> State | None:
    """Damped Gauss-Newton steps on contacts and violated caps, then a projection onto the contacts.

    Returns:
        A state at which the contact equations hold to rounding and caps and limits hold, or None.
    """
    state = start
    for _ in range(max_steps):
        c, J = manifold.linearise(state)
        g, G = manifold.inequalities(state)
        active = g < _CAP_ROOM
        r = np.concatenate([c, _CAP_WEIGHT_M * (g - _CAP_ROOM)[active]])
        A = np.vstack([J, _CAP_WEIGHT_M * G[active]])
        error = float(np.abs(r).max(initial=0.0))
        if error < 1e-7:
            break
        # Levenberg-Marquardt with damping that fades with the error, so that the last steps are Newton's.
        damping = 1e-6 * min(1.0, 1e2 * error) + 1e-14
        step = -A.T @ np.linalg.solve(A @ A.T + damping * np.eye(len(r)), r)
        state = manifold.retract(state, step * min(1.0, 0.5 / np.abs(step).max()))
    projected = manifold.project(state)
    return projected if projected is not None and manifold.is_feasible(projected) else None
