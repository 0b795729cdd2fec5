"""Before a run looks for configurations: a proof that the regions can't hold the load, if there is one."""

from collections.abc import Callable

from ...mjcf import HoldSettings
from ...objects import LiftTest, Task
from ...solver import SolveResult, Verdict, refute_balance, why_not
from .settings import RunSettings

__all__ = ["refuted_by_statics"]

# Share of the run's budget that it may take; where the regions can hold, it mostly takes milliseconds.
_SHARE = 0.05


def refuted_by_statics(
    task: Task, settings: RunSettings, hold: HoldSettings, *, should_stop: Callable[[], bool]
) -> SolveResult | None:
    """The result of a task that is proved infeasible by friction; None for any other.

    The friction is that of the hold test. Its contacts are no points: each may act anywhere within the pad's
    depth of its point, which is as far as the pad's patch reaches (`hands.Pad`).
    """
    applies = isinstance(task.test, LiftTest) and task.test.directions == hold.directions
    if not applies or why_not(task):
        return None
    friction = hold.sliding_friction(task.object)
    fixed = hold.patch_radius_m is not None and friction > 0.0
    statics = refute_balance(
        task,
        friction=friction,
        spin_arm_m=hold.torsional_friction(task.object) / friction if fixed else None,
        reach_m=task.hand.pad.thickness_m,
        budget_s=_SHARE * settings.budget_s,
        seed=settings.seed,
        should_stop=should_stop,
    )
    if statics.verdict is not Verdict.INFEASIBLE:
        return None
    return SolveResult.without_friction(task, statics, settings.sigma, settings.seed)
