"""Whether regions can hold a load with a given friction, however the hand is: refuted, or an example."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...arguments import check_budget, check_whole_number
from ...base.text.plain_text import counted
from ...objects import Task
from ..search import Progress, SearchOrder, Stopwatch, Verdict
from .climb import BalancedPoint, Climber
from .friction_worker import FrictionSetup
from .problem import check_applies, statics_problem
from .search import StaticsSearch

__all__ = ["StaticsResult", "refute_balance"]

# Points at random, some 30 us each, then so many boxes, and then local searches, before the rest of the tree.
_SAMPLES, _FIRST_BOXES, _CLIMBS, _SAMPLES_A_CLIMB = 256, 64, 24, 16


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StaticsResult:
    """What statics of a task's regions has shown.

    Attributes:
        verdict: INFEASIBLE: proved that no forces at points of the regions carry the load both ways along a
            direction; see `problem` for what that means. SOLVED: forces at `example` balance each other,
            as computed. UNDECIDED: neither.
        task: name of the task.
        friction: coefficient that was asked about.
        refuted: coefficient up to which balance is refuted; at most `friction`, 0 where nothing is.
        example: points between which forces balance with `friction`; None where none is known.
        progress: where the tree stood at the end.
    """

    verdict: Verdict
    task: str
    friction: float
    refuted: float
    example: BalancedPoint | None
    progress: Progress

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def __str__(self) -> str:
        boxes = f"{counted(self.progress.boxes, 'box', 'boxes')}, {self.progress.seconds:.1f} s"
        match self.verdict:
            case Verdict.INFEASIBLE:
                holds = f"can't hold {self.task} with friction {self.friction:.4g}"
                return f"its regions {holds}, however the hand is (proved): {boxes}"
            case Verdict.SOLVED:
                return f"forces at its regions balance with friction {self.friction:.4g}: {boxes}"
        return f"undecided whether its regions hold {self.task} with friction {self.friction:.4g}: {boxes}"


def refute_balance(
    task: Task,
    *,
    friction: float | None = None,
    spin_arm_m: float | None = None,
    reach_m: float = 0.0,
    budget_s: float = 10.0,
    seed: int = 0,
    workers: int = 1,
    proof: str | Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> StaticsResult:
    """Tries to prove that a task's regions can't hold its load, until a balanced example turns up.

    Args:
        task: a task to which statics applies; see `why_not`.
        friction: coefficient; that of the object unless given.
        spin_arm_m: see `statics_problem`.
        reach_m: see `statics_problem`.
        budget_s: time after which the search stops.
        seed: of the starts of local search; the same seed gives the same result for any number of workers,
            unless the budget ends the search.
        workers: processes to use.
        proof: file for the log (see `check_proof`), written only where balance is refuted.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used, a task to which statics doesn't apply, or a file that
            can't be written.
    """
    budget_s = check_budget("budget_s", budget_s)
    seed = check_whole_number("seed", seed, least=0)
    watch = Stopwatch()
    problem = statics_problem(check_applies(task), friction=friction, spin_arm_m=spin_arm_m, reach_m=reach_m)
    setup = FrictionSetup(
        problem=problem,
        limit=problem.friction,
        steps=0,
        order=SearchOrder.DEPTH_FIRST,
        traced=proof is not None,
    )
    search = StaticsSearch(setup, workers=workers, proof=proof, watch=watch)
    rng = np.random.default_rng(seed)

    def is_over() -> bool:
        return watch.seconds_here > budget_s or (should_stop is not None and should_stop())

    def grow(enough: Callable[[], bool]) -> None:
        search.finish(
            budget_s=budget_s,
            on_progress=on_progress,
            should_stop=should_stop,
            enough=lambda: bool(search.state.solutions) or enough(),
        )

    climber = Climber(problem)
    search.state.solutions += _sampled(climber, problem.friction, rng)
    grow(lambda: search.state.processed >= _FIRST_BOXES)
    if search.state.n_open and not search.state.solutions:
        search.state.solutions += _climbed(climber, problem.friction, rng, is_over)
        grow(lambda: False)
    left = search.state.n_open or search.state.undecided
    verdict = Verdict.SOLVED if search.state.solutions else Verdict.UNDECIDED if left else Verdict.INFEASIBLE
    if verdict is Verdict.INFEASIBLE:
        search.write_proof()
    return StaticsResult(
        verdict=verdict,
        task=task.name,
        friction=problem.friction,
        refuted=search.shown,
        example=search.best,
        progress=search.progress,
    )


def _sampled(climber: Climber, friction: float, rng: np.random.Generator) -> list[BalancedPoint]:
    """Points at which forces balance by chance, if any."""
    for _ in range(_SAMPLES):
        root, params = climber.random(rng)
        if climber.balances(root, params, friction):
            return [BalancedPoint(root, params, climber.needed_at(root, params))]
    return []


def _climbed(
    climber: Climber, friction: float, rng: np.random.Generator, is_over: Callable[[], bool]
) -> list[BalancedPoint]:
    """Points to which local search leads, if forces balance there."""
    for _ in range(_CLIMBS):
        if is_over():
            break
        point = climber.climb_from_the_best(rng, _SAMPLES_A_CLIMB)
        if point.friction <= friction:
            return [point]
    return []
