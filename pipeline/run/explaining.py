"""What would make an infeasible task possible, within a budget of its own."""

from ...base.machine.work_clock import WorkClock
from ...solver import best_friction
from ...solver.tasks import TaskRelaxation, explain_infeasible
from ..records import Explained, Relaxed, RunRecord
from .under_way import RunUnderWay

__all__ = ["explained"]

# For all relaxations together, for branch and prune in each of them, and for the least friction.
_BUDGET_S, _EACH_S, _FRICTION_S = 10.0, 0.5, 2.0


def explained(run: RunUnderWay, record: RunRecord) -> RunRecord:
    """The record of an infeasible run with what would make its task possible; itself where it has that."""
    if record.explained is not None:
        return record
    clock = WorkClock()
    budget_s = _FRICTION_S if record.lacks_friction else _BUDGET_S
    run.console.say(f"looking for what would make it possible, for {budget_s:g} s at most")

    def is_over() -> bool:
        return run.should_stop() or clock.seconds >= budget_s

    if record.lacks_friction:
        best = best_friction(run.task, budget_s=budget_s, seed=record.seed, should_stop=is_over)
        found = Explained(budget=budget_s, whole=not is_over(), friction=str(best))
    else:
        seen = explain_infeasible(run.task, budget_s=_EACH_S, seed=record.seed, should_stop=is_over)
        # What helps comes first; a reader may stop there.
        order = sorted(seen, key=lambda entry: entry.verdict.value != "solved")
        found = Explained(
            budget=budget_s, whole=not is_over(), relaxations=[_relaxed(entry) for entry in order]
        )
    return record.model_copy(update={"explained": found})


def _relaxed(entry: TaskRelaxation) -> Relaxed:
    return Relaxed.model_validate(
        {
            "kind": entry.kind.value,
            "name": entry.name,
            "verdict": entry.verdict.value,
            "words": str(entry),
        }
    )
