"""Forces of the largest common slack in friction cones and efforts, for many loads at once.

maximise s subject to A f = b, and at every force point, of h on its contact, with c = f_n - least - s / h
    |(f_1 / mu, f_2 / mu, tau / mu_t)| <= c,   (sum of f_n on the contact) + s <= most,
    |T_j f| + s W_j <= effort_j,
where W_j is the largest effort of joint j that one newton at every contact can cause, anywhere in its cones.
So each contact may lose s, or be pressed by s more, before anything slips or gives way.

A barrier method (Boyd & Vandenberghe, "Convex optimization", 2004, section 11.3): small s is always feasible,
and what it ends with is strictly inside whatever the rounding.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Indices

__all__ = ["SlackProblem", "largest_slack"]

# s within this of the largest (N); what is between ends of the barrier's path.
_GAP_N = 1e-3
_GROWTH, _MOST_STEPS, _MOST_HALVINGS = 8.0, 120, 40
# Half the square of Newton's decrement below which a point counts as on the path.
_ON_PATH = 0.05
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
    """The slack (k,) in N and the forces (k, m, 4) of each load; a slack of -inf where none balance it."""
    n, k = len(problem.least), len(problem.b)
    scale = np.ones((n, 4))
    scale[:, 1:3], scale[:, 3] = problem.mu, problem.mu_t
    A, T = problem.A * scale.ravel(), problem.T * scale.ravel()
    start, null = _solutions(A, problem.b)
    missed = np.abs(start @ A.T - problem.b).max(axis=1, initial=0.0)
    balanced = missed <= _MISSED * (1.0 + np.abs(problem.b).max(axis=1, initial=0.0))
    path = _Path(problem, T, start, null)
    z = path.follow()
    x = start + z[:, :-1] @ null.T
    slack = np.where(balanced, z[:, -1], -np.inf)
    return slack, x.reshape(k, n, 4) * scale


def _solutions(A: Array, b: Array) -> tuple[Array, Array]:
    """Least-norm solutions (k, 4 m) of A x = b for each row b, and a basis (4 m, d) of the kernel of A."""
    if not len(A):
        return np.zeros((len(b), A.shape[1])), np.eye(A.shape[1])
    U, sizes, Vt = np.linalg.svd(A)
    rank = int((sizes > 1e-10 * sizes[0]).sum())
    return (b @ U[:, :rank] / sizes[:rank]) @ Vt[:rank], Vt[rank:].T


class _Path:
    """The barrier over z = (coordinates in the kernel, s), for all loads side by side.

    In units of its cone a point's vector is x = (f_n, f_1 / mu, f_2 / mu, tau / mu_t).
    """

    def __init__(self, problem: SlackProblem, T: Array, start: Array, null: Array):
        n, d = len(problem.least), null.shape[1]
        served = np.abs(T).max(axis=1, initial=0.0) > 1e-12
        T, effort = T[served], problem.effort[served]
        by_contact = problem.contact == np.arange(problem.contact.max() + 1)[:, None]
        self._shares = 1.0 / by_contact.sum(axis=1)[problem.contact]
        at_points = T.reshape(len(T), n, 4)
        # The farthest that one newton of a contact reaches along a joint's row.
        of_points = np.abs(at_points[..., 0]) + np.linalg.norm(at_points[..., 1:], axis=-1)
        reach = np.where(by_contact, of_points[:, None], 0.0).max(axis=2).sum(axis=1)
        # Cones: v = B z + g, which must lie in |v_1..3| < v_0.
        self.B = np.concatenate([null.reshape(n, 4, d), np.zeros((n, 4, 1))], axis=2)
        self.B[:, 0, -1] = -self._shares
        self.g = start.reshape(-1, n, 4).copy()
        self.g[:, :, 0] -= problem.least
        normal, normals_at = by_contact @ null[0::4], start[:, 0::4] @ by_contact.T
        rows = [
            np.column_stack([-T @ null, -reach]),
            np.column_stack([T @ null, -reach]),
            np.column_stack([-normal, -np.ones(len(normal))]),
            np.append(np.zeros(d), -1.0)[None],
        ]
        loads = len(start)
        at = [
            effort - start @ T.T,
            effort + start @ T.T,
            min(problem.most, _LARGEST_N) - normals_at,
            np.full((loads, 1), _LARGEST_N),
        ]
        self.a, self.h = np.vstack(rows), np.hstack(at)
        self.degree = 2 * n + len(self.a)

    def follow(self) -> Array:
        """The end of the path (k, d + 1)."""
        z = np.zeros((len(self.g), self.B.shape[2]))
        z[:, -1] = self._feasible_slack() - 1.0
        weight: Array = np.ones(len(z))
        for _ in range(_MOST_STEPS):
            gradient, H = self._derivatives(z)
            gradient[:, -1] -= weight
            step = np.asarray(-np.linalg.solve(H, gradient[..., None])[..., 0], dtype=np.float64)
            decrement = 0.5 * -(gradient * step).sum(axis=1)
            z = self._moved(z, step, weight)
            near = decrement < _ON_PATH
            done = near & (self.degree / weight < _GAP_N)
            if done.all():
                break
            weight = np.where(near & ~done, _GROWTH * weight, weight)
        return z

    def _feasible_slack(self) -> Array:
        """The largest s (k,) that the least-norm forces leave."""
        in_cones = self.g[:, :, 0] - np.linalg.norm(self.g[:, :, 1:], axis=2)
        in_rows = self.h / -self.a[:, -1]
        return np.minimum((in_cones / self._shares).min(axis=1), in_rows.min(axis=1))

    def _moved(self, z: Array, step: Array, weight: Array) -> Array:
        """One step of Newton's method, halved until each load's point is inside and no worse."""
        here = self._value(z, weight)
        length = np.ones(len(z))
        for _ in range(_MOST_HALVINGS):
            there = z + length[:, None] * step
            worse = ~(self._value(there, weight) <= here + 1e-9 * np.abs(here))
            if not worse.any():
                return there
            length[worse] *= 0.5
        return np.where(worse[:, None], z, z + length[:, None] * step)

    def _value(self, z: Array, weight: Array) -> Array:
        v, r = self._places(z)
        q = v[:, :, 0] ** 2 - (v[:, :, 1:] ** 2).sum(axis=2)
        inside = (v[:, :, 0] > 0.0).all(axis=1) & (q > 0.0).all(axis=1) & (r > 0.0).all(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            value = -weight * z[:, -1] - np.log(q).sum(axis=1) - np.log(r).sum(axis=1)
        return np.where(inside, value, np.inf)

    def _places(self, z: Array) -> tuple[Array, Array]:
        n = len(self.B)
        v = (z @ self.B.reshape(4 * n, -1).T).reshape(-1, n, 4) + self.g
        return v, z @ self.a.T + self.h

    def _derivatives(self, z: Array) -> tuple[Array, Array]:
        """Gradient (k, d + 1) and Hessian (k, d + 1, d + 1) of the barrier without the objective."""
        v, r = self._places(z)
        signed = v.copy()
        signed[:, :, 1:] *= -1.0
        q = (v * signed).sum(axis=2)
        n = len(self.B)
        B = self.B.reshape(4 * n, -1)
        slopes = (-2.0 * signed / q[..., None]).reshape(-1, 4 * n)
        gradient = slopes @ B - (1.0 / r) @ self.a
        # Of -log(v0^2 - |t|^2): -2 J / q + 4 (J v)(J v)' / q^2.
        H_cones = 4.0 * signed[..., :, None] * signed[..., None, :] / (q**2)[..., None, None]
        H_cones -= 2.0 * np.diag([1.0, -1.0, -1.0, -1.0]) / q[..., None, None]
        half = H_cones @ self.B
        H = np.einsum("nca,kncb->kab", self.B, half) + np.einsum(
            "ra,kr,rb->kab", self.a, 1.0 / r**2, self.a, optimize=True
        )
        return gradient, H
