"""Configurations from which a grasp is worth making: many are solved, those that stand out are taken.

Solving costs some hundredths of a second a configuration, making a grasp of it and trying that more than one.
Where a climb from it ends is mostly decided by how far from balance it begins, and whether a turn is made
by whether the fingers have room to follow.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ..base.machine.cancellation import Cancelled, cancellable, give_up_if_asked
from ..mjcf import HoldSettings, follows_turn, start_strengths, starts_differ
from ..objects import Task, TurnTest
from ..solver import Configuration, Progress, SolveResult, solve

__all__ = ["Starts", "solve_for_starts", "strongest_first"]

# More configurations are looked for in so many times the boxes that the first ones took, and some beyond: a
# count of boxes, not a time, so that the same seed gives the same.
_TIMES_BOXES, _MORE_BOXES = 4, 64
# A start stands out whose imbalance is below this share of the median's. Smaller differences say nothing: on
# `holding`, where servos are too weak for nearly all starts alike, the strongest 16 of 64 held no better.
_STANDS_OUT = 0.25


@dataclass(frozen=True, eq=False)
class Starts:
    """What a call of the solver gave, and where grasps should begin.

    Attributes:
        result: of the solver, with all its configurations in the order in which they were found.
        configurations: the same, those first that stand out, see `strongest_first`, or can follow a turn.
    """

    result: SolveResult
    configurations: tuple[Configuration, ...]


def solve_for_starts(
    task: Task,
    *,
    count: int,
    choice: int,
    settings: HoldSettings,
    seed: int = 0,
    sigma: float = 0.1,
    budget_s: float = 60.0,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Starts:
    """Solves for `choice` times as many configurations as are needed, where they come easily.

    Args:
        task: the task.
        count: configurations that are needed.
        choice: among how many each is chosen; 1 takes them as they are found, which is done, too, where
            strength says nothing.
        settings: of the hold test that grasps should pass.
        seed: see `solve`, as are the others.
        sigma: width below which boxes are not split.
        budget_s: time after which the solver stops.
        on_progress: called after each step.
        should_stop: asked after each step, and after each configuration whose strength is measured; what was
            found by then comes in its own order.
    """
    choice = choice if starts_differ(task) or isinstance(task.test, TurnTest) else 1
    watch = _Watch(count, on_progress)
    result = solve(
        task,
        candidates=count * choice,
        seed=seed,
        sigma=sigma,
        budget_s=budget_s,
        on_progress=watch,
        should_stop=lambda: watch.has_looked_long or (should_stop is not None and should_stop()),
    )
    found = result.configurations
    if choice > 1 and should_stop is None:
        return Starts(result, _best_first(found, settings, count))
    if choice > 1 and should_stop is not None:
        with suppress(Cancelled), cancellable(should_stop):
            return Starts(result, _best_first(found, settings, count))
    return Starts(result, found)


def _best_first(
    configurations: tuple[Configuration, ...], settings: HoldSettings, count: int
) -> tuple[Configuration, ...]:
    """Those first from which a grasp is worth making; of a turn `count` at most are looked for."""
    if not configurations or not isinstance(configurations[0].task.test, TurnTest):
        return strongest_first(configurations, settings)
    followed: list[int] = []
    for i, configuration in enumerate(configurations):
        if len(followed) == count:
            break
        give_up_if_asked()
        if follows_turn(configuration):
            followed.append(i)
    others = sorted(set(range(len(configurations))) - set(followed))
    return tuple(configurations[i] for i in (*followed, *others))


def strongest_first(
    configurations: tuple[Configuration, ...], settings: HoldSettings
) -> tuple[Configuration, ...]:
    """Those first that stand out by what they could carry as they are, the best ahead; the others as given.

    See `mjcf.start_strengths`; what carries the planned load is as strong as any.
    """
    if len(configurations) < 2 or not starts_differ(configurations[0].task):
        return configurations
    strengths = np.minimum(start_strengths(configurations, settings=settings), settings.planned_load)
    median = float(np.median(strengths))
    stands_out = strengths > (_STANDS_OUT * median if median < 0.0 else median)
    order = np.argsort(np.where(stands_out, -strengths, np.inf), kind="stable")
    return tuple(configurations[i] for i in order)


class _Watch:
    """Follows a search for more configurations than are needed.

    Args:
        needed: how many are.
        on_progress: called with what is seen.
    """

    def __init__(self, needed: int, on_progress: Callable[[Progress], None] | None):
        self._needed, self._on_progress = needed, on_progress
        self._most_boxes: int | None = None
        self.has_looked_long = False

    def __call__(self, progress: Progress) -> None:
        """Sees a step of the search."""
        if self._most_boxes is None and progress.found >= self._needed:
            self._most_boxes = _TIMES_BOXES * progress.boxes + _MORE_BOXES
        self.has_looked_long = self._most_boxes is not None and progress.boxes >= self._most_boxes
        if self._on_progress is not None:
            self._on_progress(progress)
