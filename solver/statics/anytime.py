"""The best value that is found, and the bound that is shown, as both come nearer to each other."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...arguments import check_budget, check_number, check_whole_number
from ...cancellation import Cancelled, cancellable, give_up_if_asked
from ...errors import InputError
from ...plain_text import counted
from ..search import Progress, Stopwatch
from .search import StaticsSearch

__all__ = ["NEXT_TO_NOTHING", "BestGrasp", "Standing", "approach", "check_asked", "climbs", "lateness"]

NEXT_TO_NOTHING = 1e-3
"""Friction and multiples of a load that are no larger are none, and leave no gap."""

PointT = TypeVar("PointT")
EndT = TypeVar("EndT")


@dataclass(frozen=True)
class Standing:
    """What is known at a time.

    Attributes:
        seconds: since the start, that of earlier runs included.
        value: the best that was found; infinite where the least friction is asked for and no points are
            known.
        bound: what is proved: no friction below it is enough, or no larger load is carried.
    """

    seconds: float
    value: float
    bound: float

    @property
    def gap(self) -> float:
        """How far value and bound are from each other, as a share of the larger one."""
        lower, upper = sorted((self.value, self.bound))
        if upper <= NEXT_TO_NOTHING:
            return 0.0
        return 1.0 if np.isinf(upper) else 1.0 - lower / upper


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BestGrasp:
    """What was found and proved of the best grasp of a task's regions.

    Attributes:
        task: name of the task.
        history: what was known when, as it changed.
        progress: where the tree stood at the end.
        proof_written: whether a log was written.
    """

    task: str
    history: tuple[Standing, ...]
    progress: Progress
    proof_written: bool = False

    @property
    def value(self) -> float:
        """The best that was found, as computed."""
        return self.history[-1].value

    @property
    def bound(self) -> float:
        """What is proved that no grasp surpasses."""
        return self.history[-1].bound

    @property
    def gap(self) -> float:
        """How far value and bound are from each other, as a share of the larger one."""
        return self.history[-1].gap

    @property
    def effort(self) -> str:
        """What it took, in words."""
        boxes = counted(self.progress.boxes, "box", "boxes")
        return f"gap {self.gap:.1%}; {boxes}, {self.progress.seconds:.1f} s"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"


def check_asked(gap: float, budget_s: float, seed: int) -> tuple[float, float, int]:
    """These, as numbers that can be used.

    Raises:
        InputError: one can't.
    """
    gap = check_number("gap", gap, above=0.0)
    if gap >= 1.0:
        raise InputError("gap", "", f"must be a share below 1, not {gap:g}")
    return gap, check_budget("budget_s", budget_s), check_whole_number("seed", seed, least=0)


def lateness(watch: Stopwatch, seconds: float, should_stop: Callable[[], bool] | None) -> Callable[[], bool]:
    """What tells whether so much time is over, or somebody wants no more."""
    return lambda: watch.seconds_here > seconds or (should_stop is not None and should_stop())


def climbs(climb: Callable[[], EndT], most: int, is_late: Callable[[], bool]) -> Iterator[EndT]:
    """Ends of so many local searches; once it is late no other begins, and one under way is given up.

    The first is made whatever the time: without a value nothing can be pruned, nor resumed later.
    """
    yield climb()
    for _ in range(most - 1):
        try:
            with cancellable(is_late):
                give_up_if_asked()
                end = climb()
        except Cancelled:
            return
        yield end


def approach(
    search: StaticsSearch[PointT],
    standing: Callable[[], Standing],
    *,
    gap: float,
    budget_s: float,
    on_progress: Callable[[Standing, Progress], None] | None,
    should_stop: Callable[[], bool] | None,
) -> tuple[Standing, ...]:
    """Goes on until the gap is small enough, or the time is over; what was known when, as it changed.

    Args:
        search: goes on.
        standing: what it has found and shown.
        gap: share at which value and bound are near enough.
        budget_s: time after which to stop.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.
    """
    history = [standing()]

    def enough() -> bool:
        now = standing()
        if (now.value, now.bound) != (history[-1].value, history[-1].bound):
            history.append(now)
        return now.gap <= gap

    def report(progress: Progress) -> None:
        if on_progress is not None:
            on_progress(standing(), progress)

    search.finish(budget_s=budget_s, on_progress=report, should_stop=should_stop, enough=enough)
    return (*history, standing())
