"""Forces of the largest common slack in friction cones and efforts, for many loads at once.

maximise s subject to A f = b, and at every force point, of h on its contact, with c = f_n - least - s / h
    |(f_1 / mu, f_2 / mu, tau / mu_t)| <= c,   (sum of f_n on the contact) + s <= most,
    |T_j f| + s W_j <= effort_j,
where W_j is the largest effort of joint j that one newton at every contact can cause, anywhere in its cones.
So each contact may lose s, or be pressed by s more, before anything slips or gives way.

A barrier method (`barrier_path`): small s is always feasible, and what it ends with is strictly inside
whatever the rounding.
"""

from dataclasses import dataclass

import numpy as np

from ..base.numeric.arrays import Array, Indices
from .barrier_path import follow_paths

__all__ = ["SlackProblem", "largest_slack"]

# s within this of the largest (N); what is between ends of the barrier's path.
_GAP_N = 1e-3
# Largest slack and normal force in N that are looked for: they keep the path bounded where nothing else does.
_LARGEST_N = 1e3
# A load that is missed by more than this, as a share of itself, can't be balanced.
_MISSED = 1e-9


@dataclass(frozen=True, eq=False)
class SlackProblem:
    """One grasp with k loads; forces at m points are contact vectors (f_n, f_1, f_2, tau) in N and N m.

    Attributes:
        A: (rows, 4 m)
        b: (k, rows)
        T: (n_joints, 4 m)
        effort: (n_joints,)
        contact: (m,) which contact each force point belongs to.
        least: (m,) in N.
        most: of a contact, in N.
        mu: sliding friction.
        mu_t: (m,) largest torque about the normal per normal force, in m.
    """

    A: Array
    b: Array
    T: Array
    effort: Array
    contact: Indices
    least: Array
    most: float
    mu: float
    mu_t: Array


def largest_slack(problem: SlackProblem) -> tuple[Array, Array]:
    """The slack (k,) in N and the forces (k, m, 4) of each load; a slack of -inf where none balance it.

    Loads after the first that surely has no slack are not looked at, and theirs is infinite.
    """
    n, k = len(problem.least), len(problem.b)
    scale = np.ones((n, 4))
    scale[:, 1:3], scale[:, 3] = problem.mu, problem.mu_t
    A, T = problem.A * scale.ravel(), problem.T * scale.ravel()
    start, null = _solutions(A, problem.b)
    missed = np.abs(start @ A.T - problem.b).max(axis=1, initial=0.0)
    balanced = missed <= _MISSED * (1.0 + np.abs(problem.b).max(axis=1, initial=0.0))
    z, done = _follow(problem, T, start, null)
    x = start + z[:, :-1] @ null.T
    slack = np.where(balanced, z[:, -1], -np.inf)
    slack[done:] = np.inf
    return slack, x.reshape(k, n, 4) * scale


def _solutions(A: Array, b: Array) -> tuple[Array, Array]:
    """Least-norm solutions (k, 4 m) of A x = b for each row b, and a basis (4 m, d) of the kernel of A."""
    if not len(A):
        return np.zeros((len(b), A.shape[1])), np.eye(A.shape[1])
    U, sizes, Vt = np.linalg.svd(A)
    rank = int((sizes > 1e-10 * sizes[0]).sum())
    return (b @ U[:, :rank] / sizes[:rank]) @ Vt[:rank], Vt[rank:].T


def _follow(problem: SlackProblem, T: Array, start: Array, null: Array) -> tuple[Array, int]:
    """Ends (k, d + 1) of the barrier's path over z = (coordinates in the kernel, s), and of how many loads.

    In units of its cone a point's vector is x = (f_n, f_1 / mu, f_2 / mu, tau / mu_t).
    """
    n, d = len(problem.least), null.shape[1]
    served = np.abs(T).max(axis=1, initial=0.0) > 1e-12
    T, effort = T[served], problem.effort[served]
    by_contact = problem.contact == np.arange(problem.contact.max() + 1)[:, None]
    shares = 1.0 / by_contact.sum(axis=1)[problem.contact]
    at_points = T.reshape(len(T), n, 4)
    # The farthest that one newton of a contact reaches along a joint's row.
    of_points = np.abs(at_points[..., 0]) + np.linalg.norm(at_points[..., 1:], axis=-1)
    reach = np.where(by_contact, of_points[:, None], 0.0).max(axis=2).sum(axis=1)
    # Cones: v = B z + g, which must lie in |v_1..3| < v_0.
    B = np.concatenate([null.reshape(n, 4, d), np.zeros((n, 4, 1))], axis=2)
    B[:, 0, -1] = -shares
    g = start.reshape(-1, n, 4).copy()
    g[:, :, 0] -= problem.least
    normal, normals_at = by_contact @ null[0::4], start[:, 0::4] @ by_contact.T
    rows = [
        np.column_stack([-T @ null, -reach]),
        np.column_stack([T @ null, -reach]),
        np.column_stack([-normal, -np.ones(len(normal))]),
        np.append(np.zeros(d), -1.0)[None],
    ]
    at = [
        effort - start @ T.T,
        effort + start @ T.T,
        min(problem.most, _LARGEST_N) - normals_at,
        np.full((len(start), 1), _LARGEST_N),
    ]
    a, h = np.vstack(rows), np.hstack(at)
    z = np.zeros((len(g), d + 1))
    # The largest s that the least-norm forces leave, less one.
    in_cones = ((g[:, :, 0] - np.linalg.norm(g[:, :, 1:], axis=2)) / shares).min(axis=1)
    z[:, -1] = np.minimum(in_cones, (h / -a[:, -1]).min(axis=1)) - 1.0
    # In one memory layout, or each would be compiled for apart.
    B, g, a, h = (np.ascontiguousarray(array) for array in (B, g, a, h))
    return z, follow_paths(B, g, a, h, _GAP_N, z)
