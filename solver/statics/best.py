"""The least friction with which regions can hold a load: climbed to from above, refuted from below."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...objects import Task
from ..search import Progress, SearchOrder
from .anytime import NEXT_TO_NOTHING, Anytime, BestGrasp, Standing, climbs
from .climb import BalancedPoint, Climber
from .friction_worker import FrictionSetup
from .problem import StaticsProblem, check_applies, statics_problem
from .rounded import friction_down, friction_up
from .search import StaticsSearch

__all__ = ["BestFriction", "best_friction"]

# Local searches before the tree, from the best of so many random points each; fewer where some end alike.
_CLIMBS, _SAMPLES_A_CLIMB = 24, 16
_ENOUGH_ALIKE, _ALIKE = 4, 1e-3
# Bisections for a bound of a box that isn't refuted at the goal.
_STEPS = 3
# The goal is so much of the gap below the value, for what is computed from both is rounded.
_WITHIN = 0.999
# Where no points are known to balance, so much is refuted.
_LARGEST = 4.0


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BestFriction(BestGrasp):
    """The least friction with which a task's regions hold its load, whatever the hand does.

    The value is the least coefficient with which forces at some points of the regions balance; of the bound
    it is proved that no less does.

    Attributes:
        example: these points; None where none were found.
    """

    example: BalancedPoint | None

    @property
    def needs_none(self) -> bool:
        """Whether next to no friction is needed."""
        return self.value <= NEXT_TO_NOTHING

    def __str__(self) -> str:
        how = self.effort
        if self.needs_none:
            return f"{self.task}: needs next to no friction: points of its regions face each other. {how}"
        needs = "no points were found that hold it"
        if np.isfinite(self.value):
            needs = f"needs friction {friction_up(self.value)}"
        proved = "nothing is proved yet"
        if self.bound > 0.0:
            proved = f"no grasp of these regions needs less than {friction_down(self.bound)} (proved)"
        return f"{self.task}: {needs}; {proved}. {how}"


def best_friction(
    task: Task,
    *,
    gap: float = 0.02,
    budget_s: float = 60.0,
    seed: int = 0,
    spin_arm_m: float | None = None,
    reach_m: float = 0.0,
    workers: int = 1,
    proof: str | Path | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Standing, Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> BestFriction:
    """The least friction with which a task's regions hold its load, and how far it may be from the least.

    Stop it when you like: value and bound hold at any time.

    Args:
        task: a task to which statics applies; see `why_not`. Its own coefficient plays no part.
        gap: share of the value at which the bound is near enough.
        budget_s: time after which the search stops.
        seed: of the starts of local search. The number of workers has no influence on the result, and the
            same seed gives the same but for rounding in local search, unless the budget ends it.
        spin_arm_m: see `statics_problem`.
        reach_m: see `statics_problem`.
        workers: processes to use.
        proof: file for the log of what is refuted (see `check_proof`).
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used, a task to which statics doesn't apply; a checkpoint that
            exists without `resume`, is damaged, or belongs to another search; a checkpoint together with a
            proof; a file that can't be written.
    """
    asked = Anytime(
        gap=gap,
        budget_s=budget_s,
        seed=seed,
        workers=workers,
        proof=proof,
        checkpoint=checkpoint,
        resume=resume,
        on_progress=on_progress,
        should_stop=should_stop,
    )
    problem = statics_problem(check_applies(task), spin_arm_m=spin_arm_m, reach_m=reach_m)
    found = _climbed(problem, seed, asked.lateness(0.5))
    value = found[0].friction if found else np.inf
    goal = min((1.0 - _WITHIN * gap) * value, _LARGEST)
    setup = FrictionSetup(
        problem=problem, limit=goal, steps=_STEPS, order=SearchOrder.BEST_FIRST, traced=proof is not None
    )
    search, history = asked.approach(setup, found, _standing)
    return BestFriction(
        task=task.name,
        example=search.best,
        history=history,
        progress=search.progress,
        proof_written=search.write_proof(),
    )


def _climbed(problem: StaticsProblem, seed: int, is_late: Callable[[], bool]) -> tuple[BalancedPoint, ...]:
    """The best point of many climbs, if any was found."""
    climber, rng = Climber(problem), np.random.default_rng(seed)
    ends: list[BalancedPoint] = []
    for point in climbs(lambda: climber.climb_from_the_best(rng, _SAMPLES_A_CLIMB), _CLIMBS, is_late):
        if np.isfinite(point.friction):
            ends = sorted([*ends, point], key=lambda end: end.friction)
        alike = sum(end.friction <= (1.0 + _ALIKE) * ends[0].friction for end in ends)
        if alike >= _ENOUGH_ALIKE or (ends and ends[0].friction <= NEXT_TO_NOTHING):
            break
    return tuple(ends[:1])


def _standing(search: StaticsSearch[BalancedPoint]) -> Standing:
    value = np.inf if search.best is None else search.best.friction
    return Standing(search.seconds, value, min(search.shown, value))
