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
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..solver import Configuration
from .load_programme import LoadProgramme, load_programme
from .settings import HoldSettings
from .statics import grasp_statics

__all__ = ["NotHoldable", "Obstacle", "Squeeze", "plan_squeeze"]

Array = NDArray[np.float64]
# A squeeze that carries less than this share of the weight is not worth a try.
_LEAST_LOAD = 0.05
_CONE_SUBDIVISIONS = 2


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
    statics = grasp_statics(configuration)
    programme = load_programme(statics, configuration.task.object, settings, subdivisions=_CONE_SUBDIVISIONS)
    most = _largest_load(programme, settings.planned_load, limited=True)
    if most < _LEAST_LOAD:
        unlimited = _largest_load(programme, settings.planned_load, limited=False)
        return NotHoldable(Obstacle.FRICTION if unlimited < _LEAST_LOAD else Obstacle.EFFORT, most)
    # A hair less, so that rounding can't make the second programme infeasible.
    load_factor = most * (1.0 - 1e-6)
    vectors = _gentlest(programme, load_factor)
    efforts = statics.T @ vectors[0]
    contacts = vectors.reshape(len(vectors), -1, 4)
    targets = configuration.state.q + efforts / statics.stiffness
    return Squeeze(targets, efforts, contacts[0], contacts[1:], load_factor, settings)


def _largest_load(programme: LoadProgramme, planned: float, *, limited: bool) -> float:
    """Largest load factor up to the planned one, with or without the limits of effort."""
    cost = np.zeros(programme.n_unknowns)
    cost[-1] = -1.0
    solution = _solve(programme, cost, (0.0, planned), limited)
    return 0.0 if solution is None else float(solution[-1])


def _gentlest(programme: LoadProgramme, load_factor: float) -> Array:
    """Contact vectors (1 + n_directions, 4 n) with the smallest sum of normal forces in the squeeze."""
    cost = np.zeros(programme.n_unknowns)
    cost[: programme.edges.shape[1]] = 1.0
    solution = _solve(programme, cost, (load_factor, load_factor), True)
    assert solution is not None  # `_largest_load` has just found one
    return solution[:-1].reshape(programme.n_states, -1) @ programme.edges.T


def _solve(programme: LoadProgramme, cost: Array, load: tuple[float, float], limited: bool) -> Array | None:
    A_eq = programme.equations()
    A_ub = programme.efforts() if limited else np.zeros((0, len(cost)))
    bounds = [(0.0, None)] * (len(cost) - 1) + [load]
    result = linprog(cost, A_ub, np.ones(len(A_ub)), A_eq, np.zeros(len(A_eq)), bounds, method="highs")
    return result.x if result.status == 0 else None
