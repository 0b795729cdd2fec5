"""How to squeeze: joint targets whose forces balance the load, whichever way gravity acts.

The servos are springs, so once the hand has squeezed, its targets stay and the forces at the contacts follow
from the load. Let f_0 be the contact vector of the squeeze (see `statics`), which balances itself, G f_0 = 0.
A load w adds the elastic response df, the least energy df^T C df / 2 among all that carry the load,
G df = -w, where C = T^T diag(1/k) T is the compliance of the servos seen at the contacts. So the squeeze
asks for one f_0 such that for each direction of gravity f_0 + df lies in the friction cones and within the
servos' efforts. That is a linear programme once each cone

    (f_1 / mu)^2 + (f_2 / mu)^2 + (tau / mu_t)^2 <= f_n^2

(the one MuJoCo uses for `condim` 4) is replaced by the hull of edges on it, an inner approximation. The
joint targets follow from the efforts, q + T f_0 / k (the rule of Dexonomy).
"""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..solver import Configuration
from .settings import HoldSettings
from .statics import Statics, grasp_statics

__all__ = ["NotHoldable", "Squeeze", "plan_squeeze"]

Array = NDArray[np.float64]
# Compliance of skin and structure beside that of the servos, in m/N, and in rad/(N m) at an arm of 10 mm: a
# contact that no joint can move would be rigid without it.
_SKIN_COMPLIANCE = 1e-5
_SKIN_ARM_M = 0.01


@dataclass(frozen=True, eq=False)
class Squeeze:
    """A squeeze that balances the load in every direction of gravity.

    Attributes:
        targets: servo targets (n_independent,) in rad or m.
        efforts: efforts (n_independent,) of the squeeze alone, in N m or N.
        preload: contact vector (n, 4) of the squeeze alone, as in `statics`.
        loaded: contact vectors (n_directions, n, 4) under `load_factor` times the weight.
        load_factor: how many times the weight it balances, at most the planned one.
        settings: what it was planned for.
    """

    targets: Array
    efforts: Array
    preload: Array
    loaded: Array
    load_factor: float
    settings: HoldSettings

    def __post_init__(self) -> None:
        for name in ("targets", "efforts", "preload", "loaded"):
            getattr(self, name).setflags(write=False)


@dataclass(frozen=True)
class NotHoldable:
    """No squeeze balances the weight in every direction within friction cones and efforts.

    Attributes:
        load_factor: the largest share of the weight that one could balance, below 1.
        limit: what stands in the way: `friction` where unlimited efforts would not help either, else `effort`.
    """

    load_factor: float
    limit: str


def plan_squeeze(configuration: Configuration, settings: HoldSettings | None = None) -> Squeeze | NotHoldable:
    """Plans the gentlest squeeze for `settings.planned_load` times the weight, or for as much as can be had.

    Gentlest means the smallest sum of normal forces. A squeeze that reaches less than the planned load, but
    at least the weight itself, is returned too.
    """
    settings = settings or HoldSettings()
    problem = _Problem.build(configuration, settings)
    load_factor = problem.largest_load(limited=True)
    if load_factor < 1.0:
        unlimited = problem.largest_load(limited=False)
        return NotHoldable(load_factor, "friction" if unlimited < 1.0 else "effort")
    # A hair below the largest load, so that rounding can't make the second programme infeasible.
    load_factor = min(load_factor * (1.0 - 1e-6), settings.planned_load)
    preload = problem.gentlest_preload(load_factor)
    statics = problem.statics
    efforts = statics.T @ preload
    loaded = preload + load_factor * problem.responses
    return Squeeze(
        configuration.state.q + efforts / statics.stiffness,
        efforts,
        preload.reshape(-1, 4),
        loaded.reshape(len(loaded), -1, 4),
        load_factor,
        settings,
    )


@dataclass(frozen=True, eq=False)
class _Problem:
    """The linear programme of a squeeze.

    Unknowns are, for each of the states k (squeezed, then each direction of gravity), the shares of the edges
    of every contact's cone, and last the load factor s. The contact vector of state k is B lambda_k.
    """

    statics: Statics
    edges: Array  # B (4 n, 4 n_contacts * n_edges / 4): edges of all cones as columns
    responses: Array  # (n_directions, 4 n) elastic response to the weight
    effort: Array  # (n_independent,)

    @classmethod
    def build(cls, configuration: Configuration, settings: HoldSettings) -> "_Problem":
        statics = grasp_statics(configuration)
        obj = configuration.task.object
        mu = settings.planned_friction * settings.sliding_friction(obj)
        mu_t = settings.planned_friction * settings.torsional_friction(obj)
        edges = np.kron(np.eye(statics.n_contacts), _cone_edges(mu, mu_t))
        loads = statics.mass * settings.gravity * np.array(settings.directions)
        responses = elastic_responses(statics, loads)
        return cls(statics, edges, responses, settings.planned_effort * statics.effort)

    def largest_load(self, *, limited: bool) -> float:
        """Largest load factor that some squeeze balances (up to 1e3), with or without limits of effort."""
        cost = np.zeros(self._size)
        cost[-1] = -1.0
        solution = self._solve(cost, (0.0, 1e3), limited)
        return 0.0 if solution is None else float(solution[-1])

    def gentlest_preload(self, load_factor: float) -> Array:
        """Contact vector (4 n,) of the squeeze with the smallest sum of normal forces."""
        n = self.edges.shape[1]
        cost = np.zeros(self._size)
        cost[:n] = self.edges[0::4].sum(axis=0)
        solution = self._solve(cost, (load_factor, load_factor), True)
        assert solution is not None  # `largest_load` has just found one
        return self.edges @ solution[:n]

    @property
    def _size(self) -> int:
        return (1 + len(self.responses)) * self.edges.shape[1] + 1

    def _solve(self, cost: Array, load: tuple[float, float], limited: bool) -> Array | None:
        B, n = self.edges, self.edges.shape[1]
        G, T = self.statics.G, self.statics.T
        # Torques are weighed as forces at 10 mm, so that all rows are of the same order.
        scale = np.array([1.0, 1.0, 1.0, 1.0 / _SKIN_ARM_M, 1.0 / _SKIN_ARM_M, 1.0 / _SKIN_ARM_M])
        GB, normals = scale[:, None] * (G @ B), B[0::4].sum(axis=0)
        states = 1 + len(self.responses)
        A_eq = np.zeros((6 * states + states - 1, self._size))
        for k in range(states):
            A_eq[6 * k : 6 * k + 6, k * n : (k + 1) * n] = GB
            if k > 0:
                response = self.responses[k - 1]
                A_eq[6 * k : 6 * k + 6, -1] = -scale * (G @ response)
                row = A_eq[6 * states + k - 1]
                row[k * n : (k + 1) * n], row[:n], row[-1] = normals, -normals, -response[0::4].sum()
        A_ub = np.zeros((0, self._size))
        if limited:
            TB = T @ B / self.effort[:, None]
            blocks = np.kron(np.eye(states), np.vstack([TB, -TB]))
            A_ub = np.column_stack([blocks, np.zeros(len(blocks))])
        bounds = [(0.0, None)] * (self._size - 1) + [load]
        result = linprog(cost, A_ub, np.ones(len(A_ub)), A_eq, np.zeros(len(A_eq)), bounds, method="highs")
        return result.x if result.status == 0 else None


def elastic_responses(statics: Statics, loads: Array) -> Array:
    """Changes (k, 4 n) of the contact vector under forces `loads` (k, 3) in N at the centre of mass."""
    n = len(statics.G.T)
    skin = _SKIN_COMPLIANCE * np.tile([1.0, 1.0, 1.0, 1.0 / _SKIN_ARM_M**2], n // 4)
    C = (statics.T.T / statics.stiffness) @ statics.T + np.diag(skin)
    wrenches = np.column_stack([loads, np.zeros_like(loads)])
    # df = -C^-1 G^T (G C^-1 G^T)^+ w: the pseudo-inverse covers contacts that can't resist every load.
    compliant = np.linalg.solve(C, statics.G.T)
    return -(compliant @ np.linalg.pinv(statics.G @ compliant, rcond=1e-12) @ wrenches.T).T


def _cone_edges(mu: float, mu_t: float) -> Array:
    """Edges (4, k) of a soft-finger cone, at unit normal force."""
    directions = trimesh.creation.icosphere(subdivisions=2).vertices.T
    return np.vstack([np.ones(directions.shape[1]), np.diag([mu, mu, mu_t]) @ directions])
