"""A local search: from any state to one where all contacts, caps and limits of a task hold, or to nothing."""

import numpy as np
from numpy.typing import NDArray

from .contact_manifold import ContactManifold
from .state import State

__all__ = ["search_locally"]

Array = NDArray[np.float64]

# How far inside a cap the search aims, in terms of the cosine: solutions on the very edge are of little use.
_CAP_ROOM = 0.01
# An error of a cap's cosine weighs as much as this many metres.
_CAP_WEIGHT_M = 0.05
# Coordinates at their limits are held in so many rounds at most; what still leaves is clipped.
_MAX_BLOCKINGS = 4


def search_locally(manifold: ContactManifold, start: State, *, max_steps: int = 40) -> State | None:
    """Damped Gauss-Newton steps on contacts and violated caps, within limits, then a projection.

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
        step = _step_within_limits(manifold, state, A, r, damping)
        state = manifold.retract(state, step * min(1.0, 0.5 / max(float(np.abs(step).max()), 1e-300)))
    projected = manifold.project(state)
    return projected if projected is not None and manifold.is_feasible(projected) else None


def _step_within_limits(manifold: ContactManifold, state: State, A: Array, r: Array, damping: float) -> Array:
    """The damped step (n_tangent,) in which no coordinate that stands at a limit leaves it.

    Clipped afterwards instead, such coordinates would spend the step, and the search crawl.
    """
    x = np.concatenate([state.q, state.params])
    at_lower, at_upper = x <= manifold.lower, x >= manifold.upper
    step = np.zeros(manifold.n_tangent)
    for _ in range(_MAX_BLOCKINGS):
        step = -A.T @ np.linalg.solve(A @ A.T + damping * np.eye(len(r)), r)
        outward = step[manifold.bounded]
        blocked = (at_lower & (outward < 0.0)) | (at_upper & (outward > 0.0))
        if not blocked.any():
            break
        A = A.copy()
        A[:, manifold.bounded[blocked]] = 0.0
    return step
