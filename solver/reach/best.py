"""The best grasp of a task with its hand: climbed to along the contacts, bounded by statics and by reach."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...objects import Task
from ..contacts import Configuration, ContactManifold
from ..search import Progress, SearchOrder
from ..statics import (
    NEXT_TO_NOTHING,
    Anytime,
    BestGrasp,
    FrictionSetup,
    LoadProblem,
    LoadSetup,
    Standing,
    StaticsProblem,
    StaticsSearch,
    StaticsSetup,
    check_applies,
    climbs,
    friction_down,
    friction_up,
    in_time,
    load_problem,
    multiple_down,
    multiple_up,
    statics_problem,
)
from ..tasks import certify_state, solve
from .form import hand_form
from .objectives import MinusCarried, NeededFriction, Objective
from .worker import HandPoint, HandSetup, HandWorker

__all__ = ["BestWithHand", "best_with_hand"]

# Configurations that are solved for, those of them from which local search starts, the best first, and ends
# that are climbed from once more.
_SOLVED, _CLIMBS, _AGAIN = 64, 16, 2
# Shares of the budget for these two.
_SOLVING_SHARE, _CLIMBING_SHARE = 0.1, 0.4
_ENOUGH_ALIKE, _ALIKE = 3, 2e-4
# Of the gap, what is left for rounding.
_WITHIN = 0.999
# Where no configuration is known, so much friction is refuted.
_LARGEST = 4.0
_STEPS = 3


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BestWithHand(BestGrasp):
    """The best that a task's hand does with its regions.

    The value is the least friction with which forces at the contacts of some certified configuration balance,
    or the largest multiple of the load that they carry, as computed; of the bound it is proved that no
    configuration of the hand surpasses it.

    Attributes:
        goal: `friction` or `load`.
        example: the configuration; None where none was found.
        force_N: largest normal force of each contact, for the load; else None.
    """

    goal: str
    example: Configuration | None
    force_N: float | None = None

    def __str__(self) -> str:
        if self.goal == "friction" and self.value <= NEXT_TO_NOTHING:
            return f"{self.task}: the hand holds it with next to no friction. {self.effort}"
        return f"{self.task}: {self._found()}; {self._proved()}. {self.effort}"

    def _found(self) -> str:
        if self.example is None:
            return "no configuration was found that holds it"
        if self.goal == "friction":
            return f"the hand holds it with friction {friction_up(self.value)}"
        if self.value <= 0.0:
            return "no configuration was found that carries any of it"
        return (
            f"the hand carries {multiple_down(self.value)} times its weight with {self.force_N:g} N a contact"
        )

    def _proved(self) -> str:
        if self.goal == "friction" and self.bound > 0.0:
            return f"no grasp of it needs less than {friction_down(self.bound)} (proved)"
        if self.goal == "load" and np.isfinite(self.bound):
            return f"no grasp of it carries more than {multiple_up(self.bound)} times (proved)"
        return "nothing is proved yet"


def best_with_hand(
    task: Task,
    goal: str = "friction",
    *,
    max_force_N: float | None = None,
    gap: float = 0.05,
    budget_s: float = 600.0,
    seed: int = 0,
    spin_arm_m: float | None = None,
    workers: int = 1,
    proof: str | Path | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Standing, Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> BestWithHand:
    """The least friction, or the largest load, of a task with its hand, and how far it may be from the best.

    The value is climbed to along the contacts, from configurations that the solver finds. The bound is that
    of the regions, as in `best_friction` and `best_load`, but for those parts of them that the hand is proved
    not to touch all at once. Clearance and servos play no part.

    Args:
        task: a task to which statics applies.
        goal: `friction` or `load`.
        max_force_N: for the load, see `best_load`.
        gap: share at which value and bound are near enough.
        budget_s: time after which the search stops.
        seed: of local search; the same gives the same, but for rounding, unless the budget ends it.
        spin_arm_m: see `statics_problem`.
        workers: processes to use; their number has no influence on the result.
        proof: file for the log of what is refuted (see `check_proof`).
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: as `best_friction` and `best_load`.
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
    if goal not in ("friction", "load"):
        raise InputError("best", "goal", f"must be friction or load, not {goal!r}")
    setup = _setup(task, goal, max_force_N, spin_arm_m, traced=proof is not None)
    known = _climbed(setup, asked)
    setup = _limited(setup, min((point.cost for point in known), default=np.inf), gap)
    search, history = asked.approach(setup, known, partial(_standing, sign=setup.sign), "with the hand, ")
    best = search.best
    return BestWithHand(
        task=task.name,
        goal=goal,
        example=None if best is None else certify_state(ContactManifold(task), best.state),
        force_N=float(setup.problem.forces_N[0]) if isinstance(setup.problem, LoadProblem) else None,
        history=history,
        progress=search.progress,
        proof_written=search.write_proof(),
    )


def _setup(
    task: Task, goal: str, max_force_N: float | None, spin_arm_m: float | None, *, traced: bool
) -> HandSetup:
    """What is searched, with no limit yet."""
    order = SearchOrder.BEST_FIRST
    problem: StaticsProblem
    regions: StaticsSetup[Any]
    if goal == "friction":
        if max_force_N is not None:
            raise InputError("best", "max_force_N", "goes with the load; forces of any size balance or don't")
        problem = statics_problem(check_applies(task), spin_arm_m=spin_arm_m)
        problem = replace(problem, form=problem.form | {"hand": hand_form(task)})
        regions = FrictionSetup(problem=problem, limit=_LARGEST, steps=_STEPS, order=order)
        objective: Objective = NeededFriction(problem)
    else:
        load = load_problem(task, max_force_N=max_force_N, spin_arm_m=spin_arm_m)
        load = replace(load, form=load.form | {"hand": hand_form(task)})
        problem, objective = load, MinusCarried(load)
        regions = LoadSetup(problem=load, limit=0.0, known=0.0, order=order)
    return HandSetup(
        problem=problem,
        limit=regions.limit,
        order=order,
        traced=traced,
        regions=regions,
        task=task,
        objective=objective,
        sign=1.0 if goal == "friction" else -1.0,
    )


def _limited(setup: HandSetup, cost: float, gap: float) -> HandSetup:
    """The same with boxes done with once what is shown of them is near enough to a cost."""
    if setup.sign > 0.0:
        return replace(setup, limit=min((1.0 - _WITHIN * gap) * cost, _LARGEST))
    return replace(setup, limit=max(0.0, -cost) / (1.0 - _WITHIN * gap) if np.isfinite(cost) else 0.0)


def _climbed(setup: HandSetup, asked: Anytime) -> tuple[HandPoint, ...]:
    """The best configuration that local search reaches, if any."""
    worker = HandWorker(setup)
    solved = solve(
        setup.task,
        candidates=_SOLVED,
        seed=asked.seed,
        budget_s=_SOLVING_SHARE * asked.budget_s,
        should_stop=asked.should_stop,
    )
    starts = iter(sorted((c.state for c in solved), key=worker.cost)[:_CLIMBS])
    ends: list[HandPoint] = []

    def climb() -> list[HandPoint]:
        return worker.climbed_from(next(starts))

    is_late = asked.lateness(_CLIMBING_SHARE)
    for found in climbs(climb, min(_CLIMBS, len(solved)), is_late):
        ends = sorted([*ends, *found], key=lambda end: end.cost)
        alike = sum(end.cost <= ends[0].cost + _ALIKE * abs(ends[0].cost) for end in ends)
        if alike >= _ENOUGH_ALIKE:
            break
    best = [end for end in ends[:_AGAIN] if np.isfinite(end.cost)]
    for end in best[:]:
        best += in_time(partial(worker.climbed_from, end.state, at_last=True), is_late) or []
    return tuple(sorted(best, key=lambda end: end.cost)[:1])


def _standing(search: StaticsSearch[HandPoint], *, sign: float) -> Standing:
    cost = np.inf if search.best is None else search.best.cost
    if sign > 0.0:
        return Standing(search.seconds, cost, min(search.shown, cost))
    value = max(0.0, -cost) if np.isfinite(cost) else 0.0
    return Standing(search.seconds, value, max(search.shown, value))
