"""The best that regions can do, with a proof of how far it may be from the best."""

from collections.abc import Callable
from typing import Any, Literal, overload

from ..errors import InputError
from ..objects import Task
from ..solver import (
    BestFriction,
    BestLoad,
    BestWithHand,
    best_friction,
    best_load,
    best_with_hand,
    check_task,
)

__all__ = ["best"]


@overload
def best(task: Task, goal: str = "friction", *, with_hand: Literal[True], **options: Any) -> BestWithHand: ...


@overload
def best(task: Task, goal: Literal["friction"] = "friction", **options: Any) -> BestFriction: ...


@overload
def best(task: Task, goal: Literal["load"], **options: Any) -> BestLoad: ...


@overload
def best(task: Task, goal: str, **options: Any) -> BestFriction | BestLoad | BestWithHand: ...


def best(
    task: Task, goal: str = "friction", *, with_hand: bool = False, **options: Any
) -> BestFriction | BestLoad | BestWithHand:
    """The least friction with which a task's regions hold its load, or the largest load that they carry.

    Args:
        task: the task; for friction, its own friction plays no part.
        goal: `friction`: the least coefficient; `load`: the largest multiple of the load, with limited normal
            forces, whichever way gravity acts.
        with_hand: of what the task's hand reaches of the regions: the value is that of a certified
            configuration, and parts that the hand is proved not to reach don't count.
        **options: of `holdfast.solver.best_friction` or `best_load`, such as `gap=0.01`, `budget_s=60`,
            `workers=2`, and for the load `max_force_N=20`.

    Raises:
        InputError: another goal, an option that can't be used, or a task to which this doesn't apply.
    """
    if goal not in _GOALS:
        raise InputError("best", "goal", f"must be {' or '.join(_GOALS)}, not {goal!r}")
    if with_hand:
        return best_with_hand(check_task(task), goal, **options)
    return _GOALS[goal](check_task(task), **options)


_GOALS: dict[str, Callable[..., Any]] = {"friction": best_friction, "load": best_load}
