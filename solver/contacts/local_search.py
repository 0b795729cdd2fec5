"""A local search: from any state to one where all contacts, caps and limits of a task hold, or to nothing."""

import numpy as np

from ...base.machine.jit import compiled
from ...base.numeric.arrays import Array
from ...base.numeric.linalg import damped_step
from .frames import contact_frames
from .kernel import is_feasible, largest, move, project, put_equations, put_inequalities
from .manifold import ContactManifold
from .state import State
from .tables import ContactTables

__all__ = ["search_locally"]


# An error of a cap's cosine, or of the sine between normals, weighs as much as this many metres.
_CAP_WEIGHT_M = 0.05
# Coordinates at their limits are held in so many rounds at most; what still leaves is clipped.
_MAX_BLOCKINGS = 4
# Errors below this (m) are left to the projection.
_NEAR_M = 1e-7
# No coordinate moves by more than this in a step, rad or m.
_LONGEST_STEP = 0.5
_ON_MANIFOLD_M, _FEASIBLE = 1e-12, 1e-9
_MOST_PROJECTIONS = 20


def search_locally(manifold: ContactManifold, start: State, *, max_steps: int = 40) -> State | None:
    """Damped Gauss-Newton steps on contacts and violated caps, within limits, then a projection.

    Where the task leaves normals room, the steps first aim at exactly opposed ones; the projection is on what
    is left of the contacts then, for alignments may contradict each other. What that misses, steps that take
    the room as an inequality may find.

    Returns:
        A state at which the contact equations hold to rounding and caps and limits hold, or None.
    """
    tables, exact = manifold.tables, manifold.exact_tables
    for aimed_at in (tables,) if exact is tables else (exact, tables):
        x = start.copies()
        if _search(aimed_at, tables, *x, max_steps, _MOST_PROJECTIONS):
            return manifold.align(State(*x))
    return None


@compiled
def _search(
    t: ContactTables,
    task: ContactTables,
    q: Array,
    R: Array,
    p: Array,
    params: Array,
    max_steps: int,
    max_projections: int,
) -> bool:
    """`search_locally` in place, by steps on the contacts `t`; whether it landed on those of the task."""
    n = len(q) + 6 + len(params)
    r, A = np.empty(t.n_rows + t.n_inequalities), np.empty((t.n_rows + t.n_inequalities, n))
    g, G = np.empty(t.n_inequalities), np.empty((t.n_inequalities, n))
    step = np.empty(n)
    for _ in range(max_steps):
        at = contact_frames(t, q, R, p, params)
        put_equations(t, at, R, p, r, A)
        put_inequalities(t, at, g, G)
        m = _add_violated(g, G, t.aim, t.n_rows, r, A)
        error = largest(r[:m])
        if error < _NEAR_M:
            break
        # Levenberg-Marquardt with damping that fades with the error, so that the last steps are Newton's.
        damping = 1e-6 * min(1.0, 1e2 * error) + 1e-14
        _step_within_limits(t, q, params, A[:m], r[:m], damping, step)
        move(t, q, R, p, params, step, min(1.0, _LONGEST_STEP / max(largest(step), 1e-300)))
    if project(task, q, R, p, params, _ON_MANIFOLD_M, max_projections) < 0:
        return False
    return is_feasible(task, contact_frames(task, q, R, p, params), q, params, _FEASIBLE)


@compiled
def _add_violated(g: Array, G: Array, aim: Array, m: int, r: Array, A: Array) -> int:
    """Adds inequalities that hold with too little room to the first m rows; the new number of rows."""
    for k in range(len(g)):
        if g[k] < aim[k]:
            r[m] = _CAP_WEIGHT_M * (g[k] - aim[k])
            for j in range(A.shape[1]):
                A[m, j] = _CAP_WEIGHT_M * G[k, j]
            m += 1
    return m


@compiled
def _step_within_limits(
    t: ContactTables, q: Array, params: Array, A: Array, r: Array, damping: float, step: Array
) -> None:
    """The damped step (n_tangent,) in which no coordinate that stands at a limit leaves it; changes A.

    Clipped afterwards instead, such coordinates would spend the step, and the search crawl.
    """
    n = len(q)
    for _ in range(_MAX_BLOCKINGS):
        damped_step(A, r, damping, step)
        blocked = False
        for k in range(n + len(params)):
            x, j = (q[k], k) if k < n else (params[k - n], k + 6)
            if (x <= t.lower[k] and step[j] < 0.0) or (x >= t.upper[k] and step[j] > 0.0):
                blocked = True
                for i in range(len(r)):
                    A[i, j] = 0.0
        if not blocked:
            break
