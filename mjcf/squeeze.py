"""How to squeeze: servo targets whose forces balance the load, whichever way gravity acts.

The hand squeezes once; then the targets stay, whatever the load does. So the plan for a lift is one contact
vector f_0 (see `statics`) that balances itself, G f_0 = 0, such that for each direction of gravity there is a
vector f with

    G f = -s w                            it carries s times the weight w;
    (f_1^2 + f_2^2) / mu^2 + (tau / mu_t)^2 <= f_n^2    at every contact: MuJoCo's cone of `condim` 4;
    |T f| <= efforts                      the servos are strong enough;
    sum f_n = sum f_0n + s dn             the squeeze is as hard as the targets make it.

Friction may spread over the contacts as it likes: once one of them starts to slip, the others take over, and
by the lower bound theorem of limit analysis a balance inside the cones is all that is needed. Normal forces
may not: they come from servos, which are springs. Their sum changes by dn with the weight, according to the
elastic response, the one of least energy df^T C df / 2 among all that carry the load, where
C = T^T diag(1/k) T is the compliance of the servos seen at the contacts.

For a press there is one vector with f_n >= s times the force that is asked for, and for a turn one vector
whose torque about the hinge is s times its friction; `turn_plan` does that along the way.

With each cone replaced by the hull of edges on it (an inner approximation, so that what is planned is within
the true cone) this is a linear programme. First s is made as large as `planned_load`, then the squeeze as
gentle as that allows. The servo targets follow from the efforts, q + T f_0 / k (the rule of Dexonomy).

What this leaves out: that the contacts roll and that a hard pinch between compliant fingers may buckle. The
hold test judges that.
"""

from dataclasses import dataclass, field, replace
from enum import Enum
from math import atan, tan

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..objects import TurnTest
from ..solver import Configuration
from .load_programme import LoadProgramme, load_programme
from .settings import HoldSettings
from .statics import grasp_statics
from .turn_path import turn_path

__all__ = ["NotHoldable", "Obstacle", "Squeeze", "plan_squeeze"]

Array = NDArray[np.float64]
# Of the load to plan for, short of rounding.
_ENOUGH = 1.0 - 1e-5
# A squeeze that carries less than this share of the weight is not worth a try.
_LEAST_LOAD = 0.05
_CONE_SUBDIVISIONS = 2
# The way of a turn has so many states, counted without its beginning.
_TURN_STATES = 10
_TURN_LOAD = 1.1
# And goes this many times as far as it must, as the part lags behind the fingers.
_TURN_EXCESS = 1.1
# How far cones are widened, in limits of rotation. Of 24 random grasps without a plan at 1, one held,
# which has a plan at 3; of the 5 that have none at 4, none did.
_ROLLS = (1.0, 2.0, 4.0)
# Cones are not made wider than this.
_STEEPEST_RAD = 1.45
# Cost of an edge of a cone against that of the normal in its middle, for tests on a stand, where forces need
# not lean on friction: those in the middle are safe from slip.
_LEANING = 1.5


@dataclass(frozen=True, eq=False)
class Squeeze:
    """A squeeze, and what it is planned to carry.

    Attributes:
        targets: servo targets (n_independent,) in rad or m.
        efforts: efforts (n_independent,) of the squeeze alone, in N m or N.
        preload: contact vector (n, 4) of the squeeze alone, as in `statics`.
        loaded: contact vectors (n_loads, n, 4) that carry `load_factor` times the load: one a direction of
            gravity, one a state of a turn, or the squeeze itself in a press.
        load_factor: how many times the load (the weight; the friction of the hinge; the force of a press) it
            carries by the rigid-body plan, at most the planned one. Below 1 it is the best there is; rolling
            contacts often make it hold all the same. It is 0 where contacts must roll first.
        settings: what it was planned for.
        path: servo targets (k, n_independent) that follow, where the hand turns something.
    """

    targets: Array
    efforts: Array
    preload: Array
    loaded: Array
    load_factor: float
    settings: HoldSettings
    path: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        for name in ("targets", "efforts", "preload", "loaded", "path"):
            array = np.array(getattr(self, name), dtype=float)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


class Obstacle(Enum):
    """Why no squeeze carries a noticeable share of the load."""

    FRICTION = "no forces within the friction cones balance each other and the load"
    EFFORT = "the servos are too weak for the forces that would balance the load"
    REACH = "the fingers can't follow the turn with their contacts held"


@dataclass(frozen=True)
class NotHoldable:
    """No squeeze carries even a twentieth of the load in every direction, in or near this configuration.

    A hand that squeezes all the same moves the object, at times into a place where it holds.

    Attributes:
        obstacle: why.
        load_factor: the share of the load that could be carried.
    """

    obstacle: Obstacle
    load_factor: float


def plan_squeeze(configuration: Configuration, settings: HoldSettings | None = None) -> Squeeze | NotHoldable:
    """Plans the gentlest squeeze for `settings.planned_load` times the load, or for as much as possible.

    Gentlest means: with the smallest sum of normal forces. A contact may roll in the squeeze, as far as the
    limit of rotation lets the object turn, and its normal with it; links turn as well, and on curved surfaces
    the contact moves. So where no forces within the cones carry a load, cones wider by that angle, by twice
    and by four times the angle have their say: a plan with them has load factor 0 and is worth a try, and
    only where all of them fail is the grasp called not holdable.
    """
    settings = settings or HoldSettings()
    way = _way(configuration)
    if way is None:
        return NotHoldable(Obstacle.REACH, 0.0)
    for friction in settings.planned_frictions(configuration.task.object):
        outcome = _plan(way, settings, friction)
        if not isinstance(outcome, NotHoldable) and outcome.load_factor > _ENOUGH * _load(way, settings):
            return outcome
    limit = settings.rotation_limit_rad
    if not isinstance(outcome, NotHoldable) or outcome.obstacle is not Obstacle.FRICTION or limit is None:
        return outcome
    for share in _ROLLS:
        rolled = _plan(way, settings, tan(min(atan(friction) + share * limit, _STEEPEST_RAD)))
        if not isinstance(rolled, NotHoldable):
            return replace(rolled, load_factor=outcome.load_factor)
    return outcome


def _way(configuration: Configuration) -> list[Configuration] | None:
    """The configuration, with those that follow in a turn; None where the fingers can't follow."""
    test = configuration.task.test
    if not isinstance(test, TurnTest):
        return [configuration]
    way = turn_path(configuration, test, _TURN_STATES, excess=_TURN_EXCESS)
    return [configuration, *way] if len(way) == _TURN_STATES else None


def _load(way: list[Configuration], settings: HoldSettings) -> float:
    """The load factor to plan for."""
    # A torque far above the friction would drive a part ahead of the fingers that turn it, and out of them.
    return min(settings.planned_load, _TURN_LOAD) if len(way) > 1 else settings.planned_load


def _plan(way: list[Configuration], settings: HoldSettings, friction: float) -> Squeeze | NotHoldable:
    """The plan for a configuration, or for a way of several, with the friction given."""
    assumed = replace(settings, planned_load=_load(way, settings), friction=friction)
    plans = [_Plan(there, assumed) for there in way]
    most = min(plan.largest_load(limited=True) for plan in plans)
    if most < _LEAST_LOAD:
        unlimited = min(plan.largest_load(limited=False) for plan in plans)
        return NotHoldable(Obstacle.FRICTION if unlimited < _LEAST_LOAD else Obstacle.EFFORT, most)
    # A hair less, so that rounding can't make the second programme infeasible.
    load_factor = most * (1.0 - 1e-6)
    vectors = [plan.gentlest(load_factor) for plan in plans]
    efforts, targets = zip(*(plan.targets(v[0]) for plan, v in zip(plans, vectors, strict=True)), strict=True)
    # A lift has a squeeze that balances itself and others under load; the others have one vector a state.
    loaded = vectors[0][1:] if plans[0].programme.must_balance else np.concatenate(vectors)
    return Squeeze(
        targets[0], efforts[0], vectors[0][0], loaded, load_factor, settings, np.array(targets[1:])
    )


class _Plan:
    """The linear programme of one configuration, to be solved."""

    def __init__(self, configuration: Configuration, settings: HoldSettings):
        self._settings = settings
        self._q = configuration.state.q
        self._statics = grasp_statics(configuration, settings)
        self.programme = load_programme(
            self._statics, configuration.task, configuration.state, settings, subdivisions=_CONE_SUBDIVISIONS
        )

    def targets(self, contact_vector: Array) -> tuple[Array, Array]:
        """Efforts and servo targets, each (n_independent,), for a contact vector (n, 4)."""
        efforts = self._statics.T @ contact_vector.ravel()
        return efforts, self._q + efforts / self._statics.stiffness

    def largest_load(self, *, limited: bool) -> float:
        """Largest load factor up to the planned one, with or without the limits of effort."""
        cost = np.zeros(self.programme.n_unknowns)
        cost[-1] = -1.0
        solution = _solve(self.programme, cost, (0.0, self._settings.planned_load), limited=limited)
        return 0.0 if solution is None else max(0.0, float(solution[-1]))

    def gentlest(self, load_factor: float) -> Array:
        """Contact vectors (n_states, n, 4) with the smallest sum of normal forces in the squeeze.

        Each contact presses with `planned_force_N` when the load relieves it, or before it does so, or with a
        third of that, or they do so in the mean, whichever of these the load and the servos leave possible
        first: a contact without force soon lets go.
        """
        programme, load = self.programme, (load_factor, load_factor)
        n = programme.edges.shape[1]
        normals = np.zeros((self._statics.n_contacts, programme.n_unknowns))
        normals[:, :n] = programme.edges[0::4]
        cost = normals.sum(axis=0)
        if not programme.must_balance:
            cost[:n] = np.where(programme.leaning, _LEANING, 1.0)
        least = np.full(len(normals), self._settings.planned_force_N)
        relieved = least + load_factor * programme.losses
        wishes = [(normals, force) for force in (1.5 * relieved, relieved, least, least / 3.0)]
        wishes.append((normals.mean(axis=0)[None], least[:1]))
        if not programme.must_balance:
            wishes = []  # it asks for such forces itself
        for wish in wishes:
            solution = _solve(programme, cost, load, above=wish)
            if solution is not None:
                return programme.contact_vectors(solution)
        solution = _solve(programme, cost, load)
        assert solution is not None  # `largest_load` has just found one
        return programme.contact_vectors(solution)


def _solve(
    programme: LoadProgramme,
    cost: Array,
    load: tuple[float, float],
    *,
    limited: bool = True,
    above: tuple[Array, Array] | None = None,
) -> Array | None:
    """Solves the programme; with `above`, (rows, least), under rows x >= least as well."""
    kept = len(programme.A_ub) - (0 if limited else programme.n_efforts)
    A_ub, b_ub = programme.A_ub[:kept], programme.b_ub[:kept]
    if above is not None:
        rows, least = above
        A_ub, b_ub = np.vstack([A_ub, -rows]), np.concatenate([b_ub, -least])
    bounds = [(0.0, None)] * (len(cost) - 1) + [load]
    b_eq = np.zeros(len(programme.A_eq))
    result = linprog(cost, A_ub, b_ub, programme.A_eq, b_eq, bounds, method="highs")
    return result.x if result.status == 0 else None
