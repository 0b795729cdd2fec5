"""Candidates of a task that are certified, clear and squeezed, good ones and poor ones."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

from ...grasping import Clearing, ReadyGrasp, clear, squeeze_grasp, strengthen_and_clear
from ...mjcf import HoldSettings
from ...objects import Task
from ...retraction import RetractionSettings
from ...solver import Configuration, Progress, solve
from .candidate_description import candidate_features
from .stored_candidate import StoredCandidate, stored

__all__ = ["STRENGTHS", "Made", "cleared_at_strength", "make_candidates"]

STRENGTHS = (1.5, 1.0, 0.6, None)
"""What each grasp in turn is strengthened for, in multiples of the weight; None leaves it as it was solved.

Candidates that are all the best would leave little to choose."""

# Configurations asked of the solver, by those wanted, and boxes that it may look into: in place of a time, so
# that the same seed gives the same.
_TIMES, _MORE = 2, 4
_MOST_BOXES = 400
_LONGEST_S = 600.0
# Searches anew after retraction's descents have failed: each costs as much as a candidate.
_RESTARTS = 4


@dataclass(frozen=True, eq=False)
class Made:
    """What has become of a task.

    Attributes:
        candidates: those that can be tried.
        refused: why others could not be, counted.
    """

    candidates: tuple[StoredCandidate, ...]
    refused: dict[str, int]


def make_candidates(
    task: Task,
    count: int,
    *,
    seed: int = 0,
    settings: HoldSettings,
) -> Made:
    """Makes up to `count` candidates of a task; the same for the same seed.

    Args:
        task: the task.
        count: how many are wanted.
        seed: of the solver.
        settings: for which squeezes are planned.
    """
    refused: Counter[str] = Counter()
    found: list[StoredCandidate] = []
    for number, configuration in enumerate(_solved(task, count, seed)):
        if len(found) == count:
            break
        made = _make(configuration, number, f"c{len(found) + 1:02d}", settings)
        if isinstance(made, str):
            refused[made] += 1
        else:
            found.append(made)
    return Made(tuple(found), dict(sorted(refused.items())))


def cleared_at_strength(
    configuration: Configuration,
    number: int,
    settings: HoldSettings,
    retraction: RetractionSettings | None = None,
) -> Clearing:
    """The configuration freed of penetration, strengthened as its place among the candidates has it."""
    strength = STRENGTHS[number % len(STRENGTHS)]
    if strength is None:
        return clear(configuration, retraction=retraction)
    planned = replace(settings, planned_load=strength)
    return strengthen_and_clear(configuration, settings=planned, retraction=retraction)


def _solved(task: Task, count: int, seed: int) -> Iterator[Configuration]:
    boxes = 0

    def look(progress: Progress) -> None:
        nonlocal boxes
        boxes = progress.boxes

    result = solve(
        task,
        candidates=_TIMES * count + _MORE,
        seed=seed,
        budget_s=_LONGEST_S,
        on_progress=look,
        should_stop=lambda: boxes >= _MOST_BOXES,
    )
    return (configuration for configuration in result.configurations if configuration.certified)


def _make(
    configuration: Configuration, number: int, identifier: str, settings: HoldSettings
) -> StoredCandidate | str:
    """The candidate, or why there is none."""
    retraction = RetractionSettings(restarts=_RESTARTS)
    clearing = cleared_at_strength(configuration, number, settings, retraction)
    if not clearing.is_clear:
        return "sinks in"
    if not clearing.configuration.certified:
        return "not certified once clear"
    ready = squeeze_grasp(clearing.configuration, settings=settings, approach=clearing.approach)
    if not isinstance(ready, ReadyGrasp):
        return "no squeeze"
    features = candidate_features(
        ready.configuration,
        ready.squeeze,
        clearance_m=clearing.after_m,
        opening_m=ready.approach.opening_m,
        settings=settings,
        most_joints=len(configuration.task.hand.independent),
    )
    return stored(ready, identifier, clearing.after_m, features.astype(float).tolist())
