"""How to squeeze: servo targets whose forces balance the load, whichever way gravity acts.

The hand squeezes once; then the targets stay, whatever the load does. So the plan is one contact vector f_0
(see `statics`) that balances itself, G f_0 = 0, such that for each direction of gravity there is a vector f
with

    G f = -s w                            it carries s times the weight w;
    (f_1^2 + f_2^2) / mu^2 + (tau / mu_t)^2 <= f_n^2    at every contact: MuJoCo's cone of `condim` 4;
    |T f| <= efforts                      the servos are strong enough;
    sum f_n = sum f_0n + s dn             the squeeze is as hard as the targets make it.

Friction may spread over the contacts as it likes: once one of them starts to slip, the others take over, and
by the lower bound theorem of limit analysis a balance inside the cones is all that is needed. Normal forces
may not: they come from servos, which are springs. Their sum changes by dn with the weight, according to the
elastic response, the one of least energy df^T C df / 2 among all that carry the load, where
C = T^T diag(1/k) T is the compliance of the servos seen at the contacts.

With each cone replaced by the hull of edges on it (an inner approximation, so that what is planned is within
the true cone) this is a linear programme. First s is made as large as `planned_load`, then the squeeze as
gentle as that allows. The servo targets follow from the efforts, q + T f_0 / k (the rule of Dexonomy).

What this leaves out: that the contacts roll and that a hard pinch between compliant fingers may buckle. The
hold test judges that.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..solver import Configuration
from .settings import HoldSettings
from .statics import Statics, grasp_statics

__all__ = ["NotHoldable", "Obstacle", "Squeeze", "plan_squeeze"]

Array = NDArray[np.float64]
# A squeeze that carries less than this share of the weight is not worth a try.
_LEAST_LOAD = 0.05
# Compliance of skin and structure beside that of the servos, in m/N: without it, a contact that no joint can
# move would be rigid. Torques count as forces at an arm of 10 mm, here and where rows are scaled.
_SKIN_COMPLIANCE = 1e-5
_ARM_M = 0.01
_WRENCH_SCALE = np.array([1.0, 1.0, 1.0, 1.0 / _ARM_M, 1.0 / _ARM_M, 1.0 / _ARM_M])


@dataclass(frozen=True, eq=False)
class Squeeze:
    """A squeeze, and what it is planned to carry.

    Attributes:
        targets: servo targets (n_independent,) in rad or m.
        efforts: efforts (n_independent,) of the squeeze alone, in N m or N.
        preload: contact vector (n, 4) of the squeeze alone, as in `statics`.
        loaded: contact vectors (n_directions, n, 4) that carry `load_factor` times the weight.
        load_factor: how many times the weight it carries by the rigid-body plan, at most the planned one.
            Below 1 it is the best there is; rolling contacts often make it hold all the same.
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
            array = np.array(getattr(self, name), dtype=float)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


class Obstacle(Enum):
    """Why no squeeze carries a noticeable share of the weight."""

    FRICTION = "no forces within the friction cones balance each other and the load"
    EFFORT = "the servos are too weak for the forces that would balance the load"


@dataclass(frozen=True)
class NotHoldable:
    """No squeeze carries even a twentieth of the weight in every direction, in this configuration.

    A hand that squeezes all the same moves the object first, at times into a place where it holds.

    Attributes:
        obstacle: why.
        load_factor: the share of the weight that could be carried.
    """

    obstacle: Obstacle
    load_factor: float


def plan_squeeze(configuration: Configuration, settings: HoldSettings | None = None) -> Squeeze | NotHoldable:
    """Plans the gentlest squeeze for `settings.planned_load` times the weight, or for as much as possible.

    Gentlest means: with the smallest sum of normal forces.
    """
    settings = settings or HoldSettings()
    problem = _build_problem(configuration, settings)
    most = problem.largest_load(settings.planned_load, limited=True)
    if most < _LEAST_LOAD:
        unlimited = problem.largest_load(settings.planned_load, limited=False)
        return NotHoldable(Obstacle.FRICTION if unlimited < _LEAST_LOAD else Obstacle.EFFORT, most)
    # A hair less, so that rounding can't make the second programme infeasible.
    load_factor = most * (1.0 - 1e-6)
    vectors = problem.gentlest(load_factor)
    statics = problem.statics
    efforts = statics.T @ vectors[0]
    contacts = vectors.reshape(len(vectors), -1, 4)
    targets = configuration.state.q + efforts / statics.stiffness
    return Squeeze(targets, efforts, contacts[0], contacts[1:], load_factor, settings)


@dataclass(frozen=True, eq=False)
class _Problem:
    """The linear programme of a squeeze.

    There is a state for the squeeze alone and one for each direction of gravity. The unknowns are the shares
    of all cone edges in each state's contact vector, state by state, and last the load factor s.

    Attributes:
        statics: linear maps of the grasp.
        edges: (4 n, n_edges) edges of all cones as columns, each at unit normal force.
        weights: (n_directions, 6) wrenches of the weight, about the centre of mass.
        yielding: (n_directions,) change of the sum of normal forces with the weight, in N.
        effort: (n_independent,) efforts to stay within.
    """

    statics: Statics
    edges: Array
    weights: Array
    yielding: Array
    effort: Array

    def largest_load(self, planned: float, *, limited: bool) -> float:
        """Largest load factor up to the planned one, with or without the limits of effort."""
        cost = np.zeros(self._size)
        cost[-1] = -1.0
        solution = self._solve(cost, (0.0, planned), limited)
        return 0.0 if solution is None else float(solution[-1])

    def gentlest(self, load_factor: float) -> Array:
        """Contact vectors (1 + n_directions, 4 n) with the smallest sum of normal forces in the squeeze."""
        cost = np.zeros(self._size)
        cost[: self.edges.shape[1]] = 1.0
        solution = self._solve(cost, (load_factor, load_factor), True)
        assert solution is not None  # `largest_load` has just found one
        return solution[:-1].reshape(self._states, -1) @ self.edges.T

    @property
    def _states(self) -> int:
        return 1 + len(self.weights)

    @property
    def _size(self) -> int:
        return self._states * self.edges.shape[1] + 1

    def _solve(self, cost: Array, load: tuple[float, float], limited: bool) -> Array | None:
        A_eq = np.concatenate([self._balance(), self._hardness()])
        A_ub = self._efforts() if limited else np.zeros((0, self._size))
        bounds = [(0.0, None)] * (self._size - 1) + [load]
        result = linprog(cost, A_ub, np.ones(len(A_ub)), A_eq, np.zeros(len(A_eq)), bounds, method="highs")
        return result.x if result.status == 0 else None

    def _balance(self) -> Array:
        """Rows of G f_0 = 0 and G f + s w = 0."""
        rows = np.kron(np.eye(self._states), _WRENCH_SCALE[:, None] * (self.statics.G @ self.edges))
        loads = np.concatenate([np.zeros(6), (self.weights * _WRENCH_SCALE).ravel()])
        return np.column_stack([rows, loads])

    def _hardness(self) -> Array:
        """Rows of sum f_n = sum f_0n + s dn; every edge has unit normal force."""
        n = self.edges.shape[1]
        others = np.kron(np.eye(len(self.weights)), np.ones(n))
        return np.column_stack([-np.ones((len(self.weights), n)), others, -self.yielding])

    def _efforts(self) -> Array:
        """Rows of |T f| <= effort, scaled to a right side of ones."""
        T = self.statics.T @ self.edges / self.effort[:, None]
        rows = np.kron(np.eye(self._states), np.vstack([T, -T]))
        return np.column_stack([rows, np.zeros(len(rows))])


def _build_problem(configuration: Configuration, settings: HoldSettings) -> _Problem:
    statics = grasp_statics(configuration)
    obj = configuration.task.object
    cone = _cone_edges(settings.sliding_friction(obj), settings.torsional_friction(obj))
    weights = np.zeros((len(settings.directions), 6))
    weights[:, :3] = statics.mass * settings.gravity * np.array(settings.directions)
    yielding: Array = elastic_response(statics, weights)[:, 0::4].sum(axis=1)
    return _Problem(
        statics,
        np.kron(np.eye(statics.n_contacts), cone).astype(float),
        weights,
        yielding,
        settings.planned_effort * statics.effort,
    )


def elastic_response(statics: Statics, loads: Array) -> Array:
    """Changes (k, 4 n) of the contact vector under wrenches `loads` (k, 6), all contacts sticking."""
    skin = _SKIN_COMPLIANCE * np.tile([1.0, 1.0, 1.0, 1.0 / _ARM_M**2], statics.n_contacts)
    C = (statics.T.T / statics.stiffness) @ statics.T + np.diag(skin)
    # df = -C^-1 G^T (G C^-1 G^T)^+ w; pseudo-inverse, because few contacts can't resist every load.
    spread = np.linalg.solve(C, statics.G.T)
    inverse = np.linalg.pinv((_WRENCH_SCALE[:, None] * statics.G) @ (spread * _WRENCH_SCALE), rcond=1e-9)
    return -(spread * _WRENCH_SCALE @ inverse @ (loads * _WRENCH_SCALE).T).T


def _cone_edges(mu: float, mu_t: float) -> Array:
    """Edges (4, k) of a soft-finger cone at unit normal force; their hull reaches 98.5 % of the cone."""
    directions = trimesh.creation.icosphere(subdivisions=2).vertices.T
    return np.vstack([np.ones(directions.shape[1]), np.diag([mu, mu, mu_t]) @ directions])
