"""Points of regions that need little friction: local search, from many starts.

The friction is minimised together with the points and the forces that balance there, by sequential quadratic
programming, for contacts at points; wide ones need no more. What it ends at is computed, not proved.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from ...base.machine.cancellation import give_up_if_asked
from ...base.numeric.arrays import Array
from .points import RegionPoints
from .separation import BALANCED, needed_friction, separate
from .surface import point_and_normal

__all__ = ["BalancedPoint", "Climber"]

_MOST_STEPS, _TOLERANCE = 60, 1e-7
_FIRST_FRICTION = 1.0


@dataclass(frozen=True, eq=False)
class BalancedPoint:
    """Points of all regions between which forces balance.

    Attributes:
        root: which choice of charts, by number.
        params: (2 n,) parameters u, v of each contact in its chart.
        friction: coefficient that forces there need.
    """

    root: int
    params: Array
    friction: float


class Climber(RegionPoints):
    """Local search over the points of one problem."""

    def needed_at(self, root: int, params: Array) -> float:
        """The least friction with which forces at these points balance; infinite where none does."""
        return float(needed_friction(self.maps(root, params), self.problem.arms, self.problem.reaches))

    def balances(self, root: int, params: Array, friction: float) -> bool:
        """Whether forces at these points balance with a coefficient."""
        n = self.problem.n_contacts
        arms, reaches = self.problem.arms, self.problem.reaches
        return bool(
            separate(self.maps(root, params), arms, reaches, np.arange(n), friction, n)[0] == BALANCED
        )

    def climb_from_the_best(self, rng: np.random.Generator, samples: int) -> BalancedPoint:
        """Local search from that one of so many random points that needs the least friction."""
        starts = [self.random(rng) for _ in range(samples)]
        return self.climb(*min(starts, key=lambda start: self.needed_at(*start)))

    def climb(self, root: int, params: Array) -> BalancedPoint:
        """From points to such that need less friction, as far as local search goes."""
        surface = _Balance(self.chosen(root), self.problem.arms)
        start = np.concatenate([params, surface.first_forces(params), [_FIRST_FRICTION]])
        n = self.problem.n_contacts
        bounds = [(0.0, 1.0)] * (2 * n) + [(None, None)] * (4 * n) + [(0.0, None)]
        slope = np.zeros(6 * n + 1)
        slope[-1] = 1.0
        with np.errstate(all="ignore"):
            found = minimize(
                lambda z: z[-1],
                start,
                jac=lambda z: slope,
                method="SLSQP",
                bounds=bounds,
                constraints=[
                    {"type": "eq", "fun": surface.imbalance, "jac": surface.imbalance_slope},
                    {"type": "ineq", "fun": surface.room, "jac": surface.room_slope},
                ],
                options={"maxiter": _MOST_STEPS, "ftol": _TOLERANCE},
            )
        ended = np.nan_to_num(np.asarray(found.x, dtype=float)[: 2 * n], nan=0.5)
        best = np.clip(ended, 0.0, 1.0)
        return BalancedPoint(root, best, self.needed_at(root, best))


class _Balance:
    """Equations and inequalities of forces at points; unknowns are params, forces, spins and the friction.

    The spin of a contact is its torque over the spin arm, so that it counts as a force.
    """

    def __init__(self, nets: list[tuple[Array, Array]], arms: Array):
        self._nets, self._arms, self._n = nets, arms, len(arms)
        self._key = b""
        self._value: tuple[Array, ...] = ()

    def first_forces(self, params: Array) -> Array:
        """Equal normal forces, without spin."""
        _, n, _, _ = self._at(params)
        return np.concatenate([n.ravel() / self._n, np.zeros(self._n)])

    def imbalance(self, z: Array) -> Array:
        """(7,): force, torque, and the sum of normal forces less one."""
        give_up_if_asked()
        p, n, _, _ = self._at(z[: 2 * self._n])
        f, s = self._forces(z)
        torque = np.cross(p, f) + (self._arms * s)[:, None] * n
        return np.concatenate([f.sum(axis=0), torque.sum(axis=0), [(f * n).sum() - 1.0]])

    def imbalance_slope(self, z: Array) -> Array:
        """Derivatives (7, 6 n + 1)."""
        p, n, dp, dn = self._at(z[: 2 * self._n])
        f, s = self._forces(z)
        out = np.zeros((7, len(z)))
        for i in range(self._n):
            at, force = slice(2 * i, 2 * i + 2), slice(2 * self._n + 3 * i, 2 * self._n + 3 * i + 3)
            out[3:6, at] = np.cross(dp[i].T, f[i]).T + self._arms[i] * s[i] * dn[i]
            out[6, at] = f[i] @ dn[i]
            out[:3, force] = np.eye(3)
            out[3:6, force] = _cross_matrix(p[i])
            out[6, force] = n[i]
            out[3:6, 5 * self._n + i] = self._arms[i] * n[i]
        return out

    def room(self, z: Array) -> Array:
        """(2 n,): how far forces are inside their cones, squared, and normal forces."""
        _, n, _, _ = self._at(z[: 2 * self._n])
        f, s = self._forces(z)
        normal = (f * n).sum(axis=1)
        cones = (1.0 + z[-1] ** 2) * normal**2 - (f * f).sum(axis=1) - s**2
        return np.concatenate([cones, normal])

    def room_slope(self, z: Array) -> Array:
        """Derivatives (2 n, 6 n + 1)."""
        _, n, _, dn = self._at(z[: 2 * self._n])
        f, s = self._forces(z)
        normal = (f * n).sum(axis=1)
        out = np.zeros((2 * self._n, len(z)))
        wide = 2.0 * (1.0 + z[-1] ** 2) * normal
        for i in range(self._n):
            at, force = slice(2 * i, 2 * i + 2), slice(2 * self._n + 3 * i, 2 * self._n + 3 * i + 3)
            out[self._n + i, at], out[self._n + i, force] = f[i] @ dn[i], n[i]
            out[i, at], out[i, force] = wide[i] * (f[i] @ dn[i]), wide[i] * n[i] - 2.0 * f[i]
            out[i, 5 * self._n + i] = -2.0 * s[i]
            out[i, -1] = 2.0 * z[-1] * normal[i] ** 2
        return out

    def _forces(self, z: Array) -> tuple[Array, Array]:
        return z[2 * self._n : 5 * self._n].reshape(-1, 3), z[5 * self._n : 6 * self._n]

    def _at(self, params: Array) -> tuple[Array, ...]:
        """Points (n, 3), normals (n, 3) and derivatives (n, 3, 2) of both; kept, for all ask for them."""
        key = params.tobytes()
        if key != self._key:
            frames = [
                point_and_normal(points, normals, u, v)
                for (points, normals), (u, v) in zip(self._nets, params.reshape(-1, 2), strict=True)
            ]
            self._key = key
            self._value = tuple(np.array(part) for part in zip(*frames, strict=True))
        return self._value


def _cross_matrix(p: Array) -> Array:
    x, y, z = p
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
