"""Retraction: from a configuration that collides to one that does not, with the same contacts.

[1/4] measure: a configuration that is clear is returned as it is.
[2/4] descend along the contact manifold by steps of a quadratic program (`descent`).
[3/4] where that stalls, restart: from where a push leads (`push`), from where walks along the manifold lead,
      then anywhere at a growing reach (`restarts`).
[4/4] certify the result anew, and measure all its pairs.

The idea of moving along contact constraints out of penetration is that of Zhang, Kim & Manocha (RSS 2007)
and Zhang & Manocha, "An efficient retraction-based RRT planner" (ICRA 2008).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arguments import check_instance
from ..geometry import Cap, Patch
from ..objects import Task
from ..solver import Configuration, ContactManifold, State, certify_state
from ..solver.contacts import distance
from .clearance import Clearance, deciding_clearance
from .descent import Descent, PenetrationProblem, Point
from .outcome import (
    ClearConfiguration,
    FailureReason,
    RetractionFailure,
    RetractionOutcome,
    RetractionStatus,
    Route,
)
from .pairs import collision_model
from .push import push
from .restarts import land_elsewhere, rest_free_joints, walk
from .settings import RetractionSettings, checked_settings

__all__ = ["retract"]

# Length of the walks in m of motion: they start short, and each second one is longer.
_FIRST_WALK_M, _WALK_GROWTH = 0.02, 1.6
# Reach of the landings: from two fifths of the ranges, below which they end where the descent did, to all.
_FIRST_REACH, _REACH_GROWTH = 0.4, 1.6
# A walk or a landing takes some 5 ms, a descent that ends badly 30 ms: so only the best of a few is gone
# down from.
_TRIALS = 5
# A contact equation that holds to this is held.
_RESIDUAL_M = 1e-9
# A coordinate this close to its limit (rad, m or share) is said to be at it.
_AT_LIMIT = 1e-6


def retract(configuration: Configuration, *, settings: RetractionSettings | None = None) -> RetractionOutcome:
    """Makes a configuration clear while its contacts hold.

    Returns:
        A `ClearConfiguration`, which holds the very configuration given where that is clear already. It is
        certified if the given one was, its contact equations hold to 1e-9 m, limits and caps hold, and every
        pair of bodies keeps the distance that `settings` ask for. Otherwise a `RetractionFailure`: no such
        configuration was found, which does not prove that there is none.

    Raises:
        InputError: an argument of another type.
    """
    check_instance("configuration", configuration, Configuration, "a Configuration, as solve gives it")
    settings = checked_settings(settings)
    before = deciding_clearance(configuration.task, configuration.state, settings=settings)
    if before.is_clear:
        return ClearConfiguration(
            configuration=configuration,
            before_m=before.least_m,
            after_m=before.least_m,
            status=RetractionStatus.CLEAR,
            worst_pair=_names(before),
        )
    problem = _problem(configuration.task, settings)
    best: Point | None = None
    lost_certificate = False
    steps = 0
    # A descent that has ended is where walks set out from, so it is handed to what chooses the next start.
    starts = _Starts(problem, configuration.state)
    for restarts, (route, start) in enumerate(starts):
        attempt = _attempt(problem, start, configuration.certified)
        steps += attempt.descent.steps
        if attempt.configuration is not None and attempt.clearance is not None:
            return ClearConfiguration(
                configuration=attempt.configuration,
                before_m=before.least_m,
                after_m=attempt.clearance.least_m,
                status=RetractionStatus.RETRACTED,
                worst_pair=_names(attempt.clearance),
                steps=steps,
                restarts=restarts,
                route=route,
                moved=distance(configuration.state, attempt.configuration.state),
            )
        lost_certificate |= attempt.lost_certificate
        if best is None or attempt.descent.end.worst_m < best.worst_m:
            best = attempt.descent.end
            starts.best = best.state
    assert best is not None
    reached = deciding_clearance(configuration.task, best.state, settings=settings)
    reason = FailureReason.CERTIFICATE_LOST if lost_certificate else FailureReason.BLOCKED
    return _failure(configuration, before, best.state, reached, reason, steps)


@lru_cache(maxsize=16)
def _problem(task: Task, settings: RetractionSettings) -> PenetrationProblem:
    return PenetrationProblem(collision_model(task), ContactManifold(task), settings)


@dataclass(frozen=True, eq=False)
class _Attempt:
    """A descent, and the configuration it gave with its clearance; None where that is no good.

    Attributes:
        lost_certificate: whether it is clear, and would be good but for a proof.
    """

    descent: Descent
    configuration: Configuration | None = None
    clearance: Clearance | None = None
    lost_certificate: bool = False


def _attempt(problem: PenetrationProblem, start: State, must_certify: bool) -> _Attempt:
    manifold = problem.manifold
    descent = problem.descend(start)
    if descent.end.worst_m > 0.0:
        return _Attempt(descent)
    configuration = certify_state(manifold, descent.end.state)
    clearance = deciding_clearance(problem.model.task, configuration.state, settings=problem.settings)
    sound = configuration.residual_m <= _RESIDUAL_M and manifold.is_feasible(configuration.state)
    if not (clearance.is_clear and sound):
        return _Attempt(descent)
    if must_certify and not configuration.certified:
        return _Attempt(descent, lost_certificate=True)
    return _Attempt(descent, configuration, clearance)


class _Starts:
    """Where descents start: the given state, the same with free joints at rest, a push, walks, then landings.

    Attributes:
        best: the least deep state so far, from which the push sets out; walks start from the given state.
    """

    def __init__(self, problem: PenetrationProblem, state: State):
        self.best = state
        self._problem = problem
        self._state = state
        self._rng = np.random.default_rng(problem.settings.seed)

    def __iter__(self) -> Iterator[tuple[Route, State]]:
        settings = self._problem.settings
        yield Route.SLID, self._state
        if settings.restarts == 0:
            return
        rested = rest_free_joints(self._problem.manifold, self._state)
        if not np.array_equal(rested.q, self._state.q):
            yield Route.SLID, rested
        n_near = min(settings.near_restarts, settings.restarts - 1)
        for k in range(n_near):
            # A push from where the first descent ended, then walks from the given state.
            near = push(self._problem, self.best) if k == 0 else self._least_deep(self._walk(k - 1))
            if near is not None:
                yield Route.NEAR, near
        for k in range(settings.restarts - 1 - n_near):
            landed = self._least_deep(self._land(k))
            if landed is not None:
                yield Route.ANEW, landed

    def _walk(self, k: int) -> Iterator[State | None]:
        length_m = _FIRST_WALK_M * _WALK_GROWTH**k
        for _ in range(_TRIALS):
            yield walk(self._problem.manifold, self._state, self._problem.scale, length_m, self._rng)

    def _land(self, k: int) -> Iterator[State | None]:
        reach = min(1.0, _FIRST_REACH * _REACH_GROWTH**k)
        for _ in range(_TRIALS):
            yield land_elsewhere(self._problem.manifold, self._state, reach, self._rng)

    def _least_deep(self, states: Iterable[State | None]) -> State | None:
        points = [self._problem.point(state) for state in states if state is not None]
        best: Point | None = min(points, key=lambda point: point.total_m, default=None)
        return None if best is None else best.state


def _names(clearance: Clearance) -> tuple[str, str] | None:
    return None if clearance.worst is None else (clearance.worst.a, clearance.worst.b)


def _failure(
    configuration: Configuration,
    before: Clearance,
    state: State,
    reached: Clearance,
    reason: FailureReason,
    steps: int,
) -> RetractionFailure:
    blocking = sorted((pair for pair in reached.pairs if not pair.is_clear), key=lambda pair: pair.distance_m)
    limits = _active_limits(ContactManifold(configuration.task), state)
    return RetractionFailure(
        configuration=configuration,
        before_m=before.least_m,
        after_m=reached.least_m,
        blocking=tuple(blocking),
        active_limits=limits,
        state=state,
        reason=reason,
        steps=steps,
    )


def _active_limits(manifold: ContactManifold, state: State) -> tuple[str, ...]:
    """Names of the joints, patch parameters, caps and normals that are at their limits."""
    task = manifold.task
    names = list(task.hand.independent_names)
    edges = []
    for contact in task.contacts:
        if not any(isinstance(side.region, Cap) for side in (contact.hand, contact.object)):
            edges.append(f"facing of {contact.hand.name}")
        for side in (contact.hand, contact.object):
            if isinstance(side.region, Patch):
                names += [f"u of {side.name}", f"v of {side.name}"]
            if isinstance(side.region, Cap):
                edges.append(f"cap of {side.name}")
        if contact.align_within_rad > 0.0:
            edges.append(f"alignment of {contact.hand.name}")
    x = np.concatenate([state.q, state.params])
    at_limit = (x < manifold.lower + _AT_LIMIT) | (x > manifold.upper - _AT_LIMIT)
    at_edge = manifold.inequalities(state)[0] < _AT_LIMIT
    return tuple([names[i] for i in np.flatnonzero(at_limit)] + [edges[i] for i in np.flatnonzero(at_edge)])
