"""The best that regions can do, with a proof of how far it may be from the best."""

from typing import Any

from ..errors import InputError
from ..objects import Task
from ..solver import BestFriction, best_friction, check_task

__all__ = ["best"]

_GOALS = ("friction",)


def best(task: Task, goal: str = "friction", **options: Any) -> BestFriction:
    """The least friction with which a task's regions hold its load, however the hand is.

    Args:
        task: the task; its own friction plays no part.
        goal: `friction`, the only one there is.
        **options: of `holdfast.solver.best_friction`, such as `gap=0.01`, `budget_s=60`, `workers=2`.

    Raises:
        InputError: another goal, an option that can't be used, or a task to which this doesn't apply.
    """
    if goal not in _GOALS:
        raise InputError("best", "goal", f"must be {' or '.join(_GOALS)}, not {goal!r}")
    return best_friction(check_task(task), **options)
