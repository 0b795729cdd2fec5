"""Freeing a configuration of penetration, on its own or in turns with strengthening."""

from dataclasses import dataclass

from ..mjcf import HoldSettings, planned_slack, start_strengths, starts_differ, strengthen
from ..retraction import (
    Approach,
    ClearanceComparison,
    ClearConfiguration,
    RetractionFailure,
    RetractionOutcome,
    RetractionSettings,
    RetractionStatus,
    Route,
    compare_clearance,
    find_approach,
    retract,
)
from ..solver import Configuration

__all__ = ["Clearing", "clear", "strengthen_and_clear"]

# Turns of strengthening and retraction. Each ends at the top of another hill, as retraction leads somewhere
# else: of nine grasps of `service` that two turns left without balance a third one brought three to it.
_MOST_TURNS = 3
# No more than so many where contacts still lack as much as the planned load itself: none of these got there.
_TURNS_IF_FAR = 2


@dataclass(frozen=True, eq=False)
class Clearing:
    """How a configuration was freed of penetration, or why it could not be.

    Attributes:
        outcomes: of each retraction in turn, at least one; all but the last have ended clear.
        strengthened: whether strengthening has moved it in any turn.
        margin_m: distance that was asked for between bodies that should not touch.
        comparison: distances of all pairs where it is now, by FCL and by MuJoCo.
        approach: how the fingers get there; None where it is not clear.
        strengths: what it could carry before the turn that it comes from freed it, and what it can now, as
            `mjcf.start_strengths` has it; None where nothing was to be carried or nothing is clear.
    """

    outcomes: tuple[RetractionOutcome, ...]
    strengthened: bool
    margin_m: float
    comparison: ClearanceComparison
    approach: Approach | None
    strengths: tuple[float, float] | None = None

    @property
    def configuration(self) -> Configuration:
        """Where hand and object are now; where retraction failed, where it began."""
        return self.outcomes[-1].configuration

    @property
    def failure(self) -> RetractionFailure | None:
        """Why it is not clear; None where it is."""
        last = self.outcomes[-1]
        return last if isinstance(last, RetractionFailure) else None

    @property
    def is_clear(self) -> bool:
        """Whether nothing sinks in."""
        return self.failure is None

    @property
    def status(self) -> RetractionStatus:
        """Clear in every turn as it came, retracted in one at least, or failed."""
        if not self.is_clear:
            return RetractionStatus.FAILED
        return self._decisive.status

    @property
    def before_m(self) -> float:
        """Smallest signed distance before, contacts set aside; see `ClearConfiguration.before_m`."""
        return self._decisive.before_m

    @property
    def after_m(self) -> float:
        """The same after."""
        return self.outcomes[-1].after_m

    @property
    def worst_pair(self) -> tuple[str, str] | None:
        """Names of the two bodies nearest to each other after, or of those that block retraction."""
        return self.outcomes[-1].worst_pair

    @property
    def route(self) -> Route | None:
        """How retraction got there; None where it failed."""
        decisive = self._decisive
        return decisive.route if self.is_clear and isinstance(decisive, ClearConfiguration) else None

    @property
    def moved(self) -> float:
        """How far retraction has moved it, summed over the turns; see `ClearConfiguration.moved`."""
        return sum(outcome.moved for outcome in self._cleared)

    @property
    def restarts(self) -> int:
        """Places from which retraction searched before it found another configuration than the given one.

        What it came to from nearby, along its contacts, still counts as the given one.
        """
        return sum(outcome.restarts for outcome in self._cleared if outcome.route is Route.ANEW)

    @property
    def differing_pairs(self) -> tuple[tuple[str, str], ...]:
        """Names of the pairs on whose distance MuJoCo differs from FCL."""
        return tuple((pair.a, pair.b) for pair, _ in self.comparison.differing)

    @property
    def _cleared(self) -> tuple[ClearConfiguration, ...]:
        return tuple(outcome for outcome in self.outcomes if isinstance(outcome, ClearConfiguration))

    @property
    def _decisive(self) -> RetractionOutcome:
        # A later turn may find clear what an earlier one has retracted.
        return next(
            (one for one in self.outcomes if one.status is RetractionStatus.RETRACTED), self.outcomes[-1]
        )

    def __str__(self) -> str:
        return str(self.failure or f"{self.status}, nearest pair {1e3 * self.after_m:.2f} mm apart")


def clear(configuration: Configuration, *, retraction: RetractionSettings | None = None) -> Clearing:
    """Frees a configuration of penetration while its contacts hold, and finds how the fingers get there."""
    retraction = retraction or RetractionSettings()
    return _clearing((retract(configuration, settings=retraction),), False, retraction)


def strengthen_and_clear(
    configuration: Configuration, *, settings: HoldSettings, retraction: RetractionSettings | None = None
) -> Clearing:
    """`clear` for a configuration that is to be held as well.

    Strengthening and retraction take turns, as each may undo a little of what the other did; each turn ends
    with a climb that keeps what is clear so. Both keep to the contact manifold, so the contacts hold
    throughout. Turns end where the planned load is carried; of those that end clear the one counts whose
    contacts have most to spare under it.

    Args:
        configuration: from the solver.
        settings: of the hold test that it should pass.
        retraction: thresholds of clearance; None takes the defaults.
    """
    retraction = retraction or RetractionSettings()
    best: _Turn | None = None
    outcomes: tuple[RetractionOutcome, ...] = ()
    strengthened = False
    for turn in range(1, 1 + _MOST_TURNS):
        stronger = strengthen(configuration, settings=settings)
        strengthened |= stronger is not configuration
        if outcomes and stronger is configuration:
            break
        outcome = retract(stronger, settings=retraction)
        if isinstance(outcome, RetractionFailure):  # the last clear one stands
            return (
                _clearing((outcome,), strengthened, retraction)
                if best is None
                else best.ended(settings, retraction)
            )
        cleared = _climb_on(outcome, settings, retraction)
        strengthened |= cleared[-1] is not outcome
        outcomes, configuration = outcomes + cleared, cleared[-1].configuration
        slack = planned_slack(configuration, settings=settings)
        if best is None or slack > best.slack:
            best = _Turn(outcomes, strengthened, stronger, slack)
        if slack >= 0.0 or (turn >= _TURNS_IF_FAR and _is_far(best.slack, configuration, settings)):
            break
    assert best is not None
    return best.ended(settings, retraction)


def _is_far(slack: float, configuration: Configuration, settings: HoldSettings) -> bool:
    """Whether as much is lacking as the planned load, or a stand carries the object."""
    weight_N = settings.gravity * configuration.task.object.inertia.mass
    return not starts_differ(configuration.task) or slack < -settings.planned_load * weight_N


@dataclass(frozen=True, eq=False)
class _Turn:
    """The retractions up to a turn that ended clear, where it was before it was freed, and its slack."""

    outcomes: tuple[RetractionOutcome, ...]
    strengthened: bool
    stronger: Configuration
    slack: float

    def ended(self, settings: HoldSettings, retraction: RetractionSettings) -> Clearing:
        there = [self.stronger, self.outcomes[-1].configuration]
        before, after = start_strengths(there, settings=settings).tolist()
        return _clearing(self.outcomes, self.strengthened, retraction, (before, after))


def _climb_on(
    outcome: ClearConfiguration, settings: HoldSettings, retraction: RetractionSettings
) -> tuple[ClearConfiguration, ...]:
    """The outcome, and behind it a stronger one that is clear as well, where one is found nearby."""
    stronger = strengthen(outcome.configuration, settings=settings, keep_clear=retraction)
    if stronger is outcome.configuration:
        return (outcome,)
    again = retract(stronger, settings=retraction)
    return (outcome, again) if isinstance(again, ClearConfiguration) else (outcome,)


def _clearing(
    outcomes: tuple[RetractionOutcome, ...],
    strengthened: bool,
    retraction: RetractionSettings,
    strengths: tuple[float, float] | None = None,
) -> Clearing:
    last = outcomes[-1]
    reached = last.configuration
    return Clearing(
        outcomes=outcomes,
        strengthened=strengthened,
        margin_m=retraction.margin_m,
        comparison=compare_clearance(reached.task, reached.state, settings=retraction),
        approach=find_approach(reached) if isinstance(last, ClearConfiguration) else None,
        strengths=strengths,
    )
