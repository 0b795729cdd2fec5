"""The largest multiple of its load that regions can carry: climbed to from below, refuted from above."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....objects import Task
from ...search import Progress, SearchOrder
from ..anytime import NEXT_TO_NOTHING, Anytime, BestGrasp, Standing, climbs
from ..rounded import multiple_down, multiple_up
from ..search import StaticsSearch
from .climb import CarryingPoint, LoadClimber
from .problem import LoadProblem, load_problem
from .worker import LoadSetup

__all__ = ["BestLoad", "best_load"]

# Local searches before the tree, from the best of so many random points each; fewer where some end alike.
_CLIMBS, _SAMPLES_A_CLIMB = 24, 24
_ENOUGH_ALIKE, _ALIKE = 3, 2e-3
# The limit is so much of the gap above the value, for what is computed from both is rounded.
_WITHIN = 0.999


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BestLoad(BestGrasp):
    """The largest multiple of a task's load that its regions carry whichever way gravity acts.

    The value is a multiple that is carried at some points of the regions; of the bound it is proved that no
    points carry more, and it is infinite where nothing is proved.

    Attributes:
        force_N: largest normal force of each contact.
        in_test: on any grasp, however the object lies, the directions of the task's test alone may be carried
            with so many times the bound, but with no more.
        example: the points that carry `value`; None where none do.
    """

    force_N: float
    in_test: float
    example: CarryingPoint | None

    @property
    def carries_nothing(self) -> bool:
        """Whether next to nothing is carried, as proved."""
        return self.bound <= NEXT_TO_NOTHING

    def __str__(self) -> str:
        how = self.effort
        pressed = f"with {self.force_N:g} N a contact"
        if self.carries_nothing:
            return (
                f"{self.task}: carries next to none of its weight {pressed} whichever way gravity acts "
                f"(proved). {how}"
            )
        found = "no points were found that carry any of it"
        if self.value > 0.0:
            found = f"points were found that carry {multiple_down(self.value)} times"
        if np.isinf(self.bound):
            return f"{self.task}: of its weight {pressed} nothing is proved yet; {found}. {how}"
        test = ""
        if self.in_test > 1.0 + 1e-9:
            test = f"; {multiple_up(self.in_test * self.bound)} times in its test's directions alone"
        return (
            f"{self.task}: carries at most {multiple_up(self.bound)} times its weight {pressed} whichever "
            f"way gravity acts (proved{test}); {found}. {how}"
        )


def best_load(
    task: Task,
    *,
    max_force_N: float | None = None,
    gap: float = 0.02,
    budget_s: float = 60.0,
    seed: int = 0,
    spin_arm_m: float | None = None,
    workers: int = 1,
    proof: str | Path | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Standing, Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> BestLoad:
    """The largest multiple of a task's load that its regions carry, and how far it may be from the largest.

    Each contact presses with a limited normal force at one point of its region, with the object's friction,
    and carries the load whichever way gravity acts. Stop it when you like: value and bound hold at any time.

    Args:
        task: a task to which this applies; see `why_no_load`.
        max_force_N: largest normal force of each contact; that of the task or its hand unless given, or what
            the hand's fingertips are rated for.
        gap: share of the bound at which the value is near enough.
        budget_s: time after which the search stops.
        seed: of the starts of local search. The number of workers has no influence on the result, and the
            same seed gives the same but for rounding in local search, unless the budget ends it.
        spin_arm_m: see `statics_problem`.
        workers: processes to use.
        proof: file for the log of what is refuted (see `check_proof`).
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used, a task to which this doesn't apply, or of which nothing
            says how hard its contacts may press; a checkpoint that exists without `resume`, is damaged, or
            belongs to another search; a checkpoint together with a proof; a file that can't be written.
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
    problem = load_problem(task, max_force_N=max_force_N, spin_arm_m=spin_arm_m)
    found = _climbed(problem, seed, asked.lateness(0.5))
    value = found[0].multiple if found else 0.0
    setup = LoadSetup(
        problem=problem,
        limit=value / (1.0 - _WITHIN * gap),
        known=value * (1.0 + 1e-4),
        order=SearchOrder.BEST_FIRST,
        traced=proof is not None,
    )
    search, history = asked.approach(setup, found, _standing)
    return BestLoad(
        task=task.name,
        force_N=float(problem.forces_N[0]),
        in_test=1.0 / problem.cosine,
        example=search.best,
        history=history,
        progress=search.progress,
        proof_written=search.write_proof(),
    )


def _climbed(problem: LoadProblem, seed: int, is_late: Callable[[], bool]) -> tuple[CarryingPoint, ...]:
    """The best point of many climbs, if any carries something."""
    climber, rng = LoadClimber(problem), np.random.default_rng(seed)
    best: CarryingPoint | None = None
    ends: list[float] = []

    def climb() -> tuple[float, CarryingPoint | None]:
        known = 0.0 if best is None else best.multiple
        return climber.climb(*climber.start(rng, _SAMPLES_A_CLIMB), known)

    for estimate, point in climbs(climb, _CLIMBS, is_late):
        best = point or best
        ends.append(estimate)
        alike = sum(end >= (1.0 - _ALIKE) * max(ends) for end in ends)
        if alike >= _ENOUGH_ALIKE:
            break
    return () if best is None else (best,)


def _standing(search: StaticsSearch[CarryingPoint]) -> Standing:
    value = 0.0 if search.best is None else search.best.multiple
    return Standing(search.seconds, value, max(search.shown, value))
