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
whose torque about the hinge is s times its friction, at each state of the way.

With each cone replaced by the hull of edges on it (an inner approximation, so that what is planned is within
the true cone) this is a linear program. A wide contact (see `pads`) has several force points, each with its
cone; what they come to acts at the centre of its pressure. First s is made as large as `planned_load`, then
the squeeze as gentle as that allows. The servo targets follow from f_0 (see `straight`).

What this leaves out: that the contacts roll and that a hard pinch between compliant fingers may buckle. The
hold test judges that.
"""

from dataclasses import dataclass, replace
from math import atan, tan

import numpy as np

from ...base.numeric.arrays import Array
from ...objects import PressTest, TurnTest
from ...solver import Configuration
from ..model import Squeeze, check_configuration, checked_settings
from ..settings import HoldSettings
from .linear_program import Optimum, largest_last, minimise
from .load_program import STEEPEST_RAD, LoadProgram, load_program
from .pads import ContactPads, contact_pads
from .press_unplanned import press_along_normals
from .refusal import NotHoldable, why_not_holdable
from .sparse_rows import SparseRows
from .statics import Statics, grasp_statics
from .straight import straight_targets
from .turn_path import squeeze_trajectory
from .turn_room import why_not_followed

__all__ = ["plan_squeeze"]

# Of the load to plan for, short of rounding.
_ENOUGH = 1.0 - 1e-5
# A squeeze that carries less than this share of the weight is not worth a try.
_LEAST_LOAD = 0.05
_CONE_SUBDIVISIONS = 2
_TURN_LOAD = 1.1
# A finger that can't go straight into what it presses comes to little more than half of what is planned.
_PRESS_TIMES = 4.0 / 3.0
# Plans for arms of spin friction, and by which share these may be smaller than planned with.
_MOST_ROUNDS = 3
_SAME_ARM = 0.1
# How far cones are widened, in limits of rotation.
_ROLLS = (1.0, 2.0, 4.0)
# Normal force in N of contacts that press where there is no plan.
_UNPLANNED_N = 10.0
# Cost of an edge of a cone against that of the normal in its middle, for tests on a stand, where forces need
# not lean on friction: those in the middle are safe from slip.
_LEANING = 1.5


def plan_squeeze(
    configuration: Configuration, *, settings: HoldSettings | None = None
) -> Squeeze | NotHoldable:
    """Plans the gentlest squeeze for `settings.planned_load` times the load, or for as much as possible.

    Gentlest means: with the smallest sum of normal forces. Where no plan carries the whole load, the grasp
    may be one that no forces of the hand can hold (see `refusal`); then that is the answer. Any other one is
    worth a try. A contact may roll in the squeeze, as far as the limit of rotation lets the object turn, and
    its normal with it; links turn as well, and on curved surfaces the contact moves. So where forces within
    the cones carry next to nothing, there follow plans with cones wider by that angle, by twice and by four
    times the angle, and at last contacts that press along their normals.
    """
    check_configuration(configuration)
    settings = checked_settings(settings)
    way = squeeze_trajectory(configuration)
    if isinstance(configuration.task.test, TurnTest):
        barred = why_not_followed(way, settings.slip_limit_m)
        if barred is not None:
            return NotHoldable(barred, 0.0)
    places = [_Place.of(there, settings) for there in way]
    *sparing, whole = settings.planned_frictions(configuration.task.object)
    enough = _ENOUGH * _load(places, settings)
    for friction in sparing:
        best = _plan(places, settings, friction, enough)
        if best is not None and best.load_factor > enough:
            return best
    best = _plan(places, settings, whole)
    if best is not None and best.load_factor > enough:
        return best
    if best is None or best.load_factor < 1.0:
        refusal = why_not_holdable(configuration, settings)
        if refusal is not None:
            return refusal
    return best or _attempt(places, settings)


@dataclass(frozen=True, eq=False)
class _Place:
    """A configuration to be squeezed in, with what no plan changes."""

    configuration: Configuration
    statics: Statics
    pads: ContactPads

    @classmethod
    def of(cls, configuration: Configuration, settings: HoldSettings) -> "_Place":
        """That of a configuration."""
        pads = contact_pads(configuration, settings)
        return cls(configuration, grasp_statics(configuration, settings, pads.force_points()), pads)


def _attempt(way: list[_Place], settings: HoldSettings) -> Squeeze:
    """A squeeze where forces within the cones carry next to nothing."""
    friction = settings.sliding_friction(way[0].configuration.task.object)
    limit = settings.rotation_limit_rad
    angles = [] if limit is None else [atan(friction) + share * limit for share in _ROLLS]
    for angle in angles:
        rolled = _plan(way, settings, tan(min(angle, STEEPEST_RAD)))
        if rolled is not None:
            return replace(rolled, load_factor=0.0)
    return press_along_normals(way[0].configuration, _UNPLANNED_N, settings=settings)


def _load(way: list[_Place], settings: HoldSettings) -> float:
    """The load factor to plan for."""
    match way[0].configuration.task.test:
        case TurnTest():
            # A torque far above the friction would drive a part ahead of the fingers, and out of them.
            return min(settings.planned_load, _TURN_LOAD)
        case PressTest():
            return _PRESS_TIMES * settings.planned_load
        case _:
            return settings.planned_load


def _plan(
    way: list[_Place], settings: HoldSettings, friction: float, enough: float = _LEAST_LOAD
) -> Squeeze | None:
    """The plan for a configuration, or for a way of several; None where none can carry `enough`.

    How well a pad resists spin depends on its force, which is what is planned: so it is planned again with
    the arms that the forces make, until they agree.
    """
    assumed = replace(settings, planned_load=_load(way, settings), friction=friction)
    plans = [_Plan(there, assumed) for there in way]
    for _ in range(_MOST_ROUNDS):
        most = min(plan.largest_load() for plan in plans)
        if most < _LEAST_LOAD or (most < enough and not all(plan.may_carry(enough) for plan in plans)):
            return None
        # A hair less, so that rounding can't make the second program infeasible.
        load_factor = most * (1.0 - 1e-6)
        forces = [plan.gentlest(load_factor) for plan in plans]
        if all(plan.agrees(there.vectors[0]) for plan, there in zip(plans, forces, strict=True)):
            break
        plans = [plan.again(there.vectors[0]) for plan, there in zip(plans, forces, strict=True)]
    pairs = (plan.targets(there) for plan, there in zip(plans, forces, strict=True))
    efforts, targets = zip(*pairs, strict=True)
    # A lift has a squeeze that balances itself and others under load; the others have one vector a state.
    squeeze = forces[0]
    under_load = [squeeze.loaded] if plans[0].program.must_balance else forces
    pads, normals_N = plans[0].pads, squeeze.vectors[0][:, 0]
    return Squeeze(
        targets=targets[0],
        efforts=efforts[0],
        preload=squeeze.vectors[0],
        loaded=np.concatenate([there.vectors for there in under_load]),
        load_factor=load_factor,
        settings=settings,
        spin_arms_m=pads.spin_arms_m(normals_N),
        yields_m=_spring_yields_m(pads, [there.vectors[0, :, 0] for there in forces]),
        centres_m=squeeze.centres_m[0],
        loaded_centres_m=np.concatenate([there.centres_m for there in under_load]),
        path=np.array(targets[1:]),
    )


def _spring_yields_m(pads: ContactPads, normals_N: list[Array]) -> Array:
    """How far each pad (n,) yields in the squeeze, being in the test one spring for all states of the way.

    A pad's force grows with the square of its yield. On the way of a turn another finger may push than in the
    squeeze: so the spring is that of the mean of a pad's forces, which are given (n,) state by state.
    """
    if len(normals_N) == 1:
        return pads.yields_m(normals_N[0])
    mean_N = np.maximum(np.mean(normals_N, axis=0), 1e-9)
    yields_m: Array = pads.yields_m(mean_N) * normals_N[0] / mean_N
    return yields_m


@dataclass(frozen=True, eq=False)
class _Forces:
    """Forces of k states at the centres of pressure of n contacts.

    Attributes:
        vectors: contact vectors (k, n, 4).
        centres_m: (k, n, 2), see `Squeeze`.
    """

    vectors: Array
    centres_m: Array

    @property
    def loaded(self) -> "_Forces":
        """Those behind the first."""
        return _Forces(self.vectors[1:], self.centres_m[1:])


class _Plan:
    """The linear program of one configuration, to be solved.

    Args:
        place: the grasp, or a state of a turn.
        settings: what to plan for.
        spin_arms_m: arms (n,) of spin friction to plan with; None for those under a usual force.
        start: solution of the largest load with other arms, near which this one's is.
    """

    def __init__(
        self,
        place: _Place,
        settings: HoldSettings,
        spin_arms_m: Array | None = None,
        start: Optimum | None = None,
    ):
        self._place, self._settings = place, settings
        self._statics, self.pads = place.statics, place.pads
        self._spin_arms_m = self.pads.spin_arms_m() if spin_arms_m is None else spin_arms_m
        self._largest = start
        self.program = self._program(self._spin_arms_m)

    def _program(self, spin_arms_m: Array) -> LoadProgram:
        return load_program(
            self._statics,
            self._place.configuration.task,
            self._place.configuration.state,
            self._settings,
            subdivisions=_CONE_SUBDIVISIONS,
            spin_arms_m=spin_arms_m,
        )

    def agrees(self, contact_vector: Array) -> bool:
        """Whether the arms that a plan (n, 4) makes are about those that it was made with."""
        ratio = self.pads.spin_arms_m(contact_vector[:, 0]) / self._spin_arms_m
        return bool(ratio.min() >= 1.0 - _SAME_ARM and ratio.max() <= 1.0 + 2.0 * _SAME_ARM)

    def again(self, contact_vector: Array) -> "_Plan":
        """The same with the arms that a plan (n, 4) makes."""
        arms_m = self.pads.spin_arms_m(contact_vector[:, 0])
        return _Plan(self._place, self._settings, arms_m, self._largest)

    def targets(self, forces: _Forces) -> tuple[Array, Array]:
        """Efforts and servo targets, each (n_independent,), for the first of the states."""
        vector, centres_m = forces.vectors[0], forces.centres_m[0]
        yields_m = self.pads.yields_m(vector[:, 0])
        return straight_targets(self._place.configuration, self._statics, vector, yields_m, centres_m)

    def largest_load(self) -> float:
        """Largest load factor up to the planned one; 0 for none."""
        self._largest = self._load_of(self.program)
        return 0.0 if self._largest is None else max(0.0, -self._largest.value)

    def may_carry(self, load_factor: float) -> bool:
        """Whether it is carried with the largest arms of spin friction that any forces make."""
        # The longer the arms, the wider the cones.
        optimum = self._load_of(self._program(self.pads.largest_arms_m()))
        return optimum is not None and -optimum.value >= load_factor

    def _load_of(self, program: LoadProgram) -> Optimum | None:
        rows, most = program.rows, self._settings.planned_load
        return largest_last(rows.A_eq, rows.A_ub, rows.b_ub, most, start=self._largest)

    def gentlest(self, load_factor: float) -> _Forces:
        """The forces with the smallest sum of normal ones in the squeeze.

        Each contact presses with `planned_force_N` when the load relieves it, or before it does so, or with a
        third of that, or they do so in the mean, whichever of these the load and the servos leave possible
        first: a contact without force soon lets go.
        """
        program = self.program
        n = program.edges.shape[1]
        normals = np.zeros((self._statics.n_contacts, program.n_unknowns))
        normals[:, :n] = program.by_contact
        cost = normals.sum(axis=0)
        if not program.must_balance:
            cost[:n] = np.where(program.leaning, _LEANING, 1.0)
        least = np.full(len(normals), self._settings.planned_force_N)
        relieved = least + load_factor * program.rows.losses
        wishes = [(normals, force) for force in (1.5 * relieved, relieved, least, least / 3.0)]
        wishes.append((normals.mean(axis=0)[None], least[:1]))
        if not program.must_balance:
            wishes = []  # it asks for such forces itself
        for wish in wishes:
            solution = _solve(program, cost, load_factor, above=wish)
            if solution is not None:
                return self._resultants(solution)
        solution = _solve(program, cost, load_factor)
        assert solution is not None  # `largest_load` has just found one
        return self._resultants(solution)

    def _resultants(self, solution: Array) -> _Forces:
        vectors = self.program.contact_vectors(solution)
        return _Forces(*self._statics.force_points.resultants(vectors))


def _solve(
    program: LoadProgram,
    cost: Array,
    load_factor: float,
    *,
    above: tuple[Array, Array] | None = None,
) -> Array | None:
    """Solves the program at a load factor; with `above`, (rows, least), under rows x >= least as well."""
    A_ub, b_ub = program.rows.A_ub, program.rows.b_ub
    if above is not None:
        rows, least = above
        A_ub, b_ub = SparseRows.stacked(A_ub, SparseRows.of(-rows)), np.concatenate([b_ub, -least])
    bounds = {-1: (load_factor, load_factor)}
    optimum = minimise(cost, program.rows.A_eq, None, A_ub, b_ub, bounds=bounds, any_optimum=False)
    return None if optimum is None else optimum.x
