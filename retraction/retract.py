"""Retraction: from a configuration that collides to one that does not, with the same contacts.

[1/4] measure: a configuration that is clear is returned as it is.
[2/4] descend along the contact manifold by steps of a quadratic program (`descent`).
[3/4] where that stalls, restart elsewhere on the manifold (`restarts`), at a growing reach.
[4/4] certify the result anew, and measure all its pairs.

The idea of moving along contact constraints out of penetration is that of Zhang, Kim & Manocha (RSS 2007)
and Zhang & Manocha, "An efficient retraction-based RRT planner" (ICRA 2008).
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..geometry import Cap, Patch
from ..objects import Task
from ..solver import Configuration, ContactManifold, State, certify_state
from .clearance import Clearance, compute_clearance
from .descent import Descent, Terrain
from .outcome import ClearConfiguration, FailureReason, RetractionFailure, RetractionOutcome
from .pairs import collision_model
from .restarts import rest_free_joints
from .settings import RetractionSettings

__all__ = ["retract", "retract_all"]

# Reach of the restarts: from a tenth of the ranges to all of them within a handful.
_FIRST_REACH, _REACH_GROWTH = 0.2, 1.7
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
    """
    settings = settings or RetractionSettings()
    before = compute_clearance(configuration.task, configuration.state, settings=settings)
    if before.is_clear:
        return ClearConfiguration(configuration, before.least_m, before.least_m, "clear", _names(before))
    terrain = _terrain(configuration.task, settings)
    best: _Attempt | None = None
    lost_certificate = False
    steps = 0
    for restarts, start in enumerate(_starts(terrain, configuration.state)):
        attempt = _attempt(terrain, start, configuration.certified)
        steps += attempt.descent.steps
        if attempt.configuration is not None:
            assert attempt.clearance.is_clear
            return ClearConfiguration(
                attempt.configuration,
                before.least_m,
                attempt.clearance.least_m,
                "retracted",
                _names(attempt.clearance),
                steps,
                restarts,
            )
        lost_certificate |= attempt.lost_certificate
        if best is None or attempt.clearance.least_m > best.clearance.least_m:
            best = attempt
    assert best is not None
    return _failure(configuration, before, best, "certificate lost" if lost_certificate else "blocked", steps)


def retract_all(
    configurations: Iterable[Configuration], *, settings: RetractionSettings | None = None
) -> list[RetractionOutcome]:
    """`retract` for many configurations; each outcome is the same as it would be alone."""
    return [retract(configuration, settings=settings) for configuration in configurations]


@lru_cache(maxsize=16)
def _terrain(task: Task, settings: RetractionSettings) -> Terrain:
    return Terrain(collision_model(task), ContactManifold(task), settings)


@dataclass(frozen=True, eq=False)
class _Attempt:
    """A descent, and the configuration it gave; None where that is not clear, or lost its certificate."""

    descent: Descent
    clearance: Clearance
    configuration: Configuration | None
    lost_certificate: bool


def _attempt(terrain: Terrain, start: State, must_certify: bool) -> _Attempt:
    task, manifold = terrain.model.task, terrain.manifold
    descent = terrain.descend(start)
    clearance = compute_clearance(task, descent.end.state, settings=terrain.settings)
    if not clearance.is_clear:
        return _Attempt(descent, clearance, None, False)
    configuration = certify_state(manifold, descent.end.state)
    clearance = compute_clearance(task, configuration.state, settings=terrain.settings)
    sound = configuration.residual_m <= _RESIDUAL_M and manifold.is_feasible(configuration.state)
    lost = must_certify and not configuration.certified
    accepted = clearance.is_clear and sound and not lost
    return _Attempt(descent, clearance, configuration if accepted else None, lost)


def _starts(terrain: Terrain, state: State) -> Iterator[State]:
    """The given state, the same with free joints at rest, then landings ever further away."""
    yield state
    settings, manifold = terrain.settings, terrain.manifold
    if settings.restarts == 0:
        return
    yield rest_free_joints(manifold, state)
    rng = np.random.default_rng(settings.seed)
    for k in range(settings.restarts - 1):
        reach = min(1.0, _FIRST_REACH * _REACH_GROWTH**k)
        landed = terrain.land_elsewhere(state, reach, rng)
        if landed is not None:
            yield landed


def _names(clearance: Clearance) -> tuple[str, str] | None:
    return None if clearance.worst is None else (clearance.worst.a, clearance.worst.b)


def _failure(
    configuration: Configuration, before: Clearance, best: _Attempt, reason: FailureReason, steps: int
) -> RetractionFailure:
    state = best.descent.end.state
    blocking = sorted(
        (pair for pair in best.clearance.pairs if not pair.is_clear), key=lambda pair: pair.distance_m
    )
    limits = _active_limits(ContactManifold(configuration.task), state)
    return RetractionFailure(
        configuration,
        before.least_m,
        best.clearance.least_m,
        tuple(blocking),
        limits,
        state,
        reason,
        steps,
    )


def _active_limits(manifold: ContactManifold, state: State) -> tuple[str, ...]:
    """Names of the joints, patch parameters and caps that are at their limits."""
    task = manifold.task
    names = list(task.hand.independent_names)
    caps = []
    for contact in task.contacts:
        for side in (contact.hand, contact.object):
            if isinstance(side.region, Patch):
                names += [f"u of {side.name}", f"v of {side.name}"]
            if isinstance(side.region, Cap):
                caps.append(f"cap of {side.name}")
    x = np.concatenate([state.q, state.params])
    at_limit = (x < manifold.lower + _AT_LIMIT) | (x > manifold.upper - _AT_LIMIT)
    at_edge = manifold.inequalities(state)[0] < _AT_LIMIT
    return tuple([names[i] for i in np.flatnonzero(at_limit)] + [caps[i] for i in np.flatnonzero(at_edge)])
