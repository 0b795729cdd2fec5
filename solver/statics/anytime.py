"""The best value that is found, and the bound that is shown, as both come nearer to each other."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...arguments import check_budget, check_number, check_whole_number
from ...errors import InputError
from ..search import Progress
from .search import StaticsSearch

__all__ = ["Standing", "approach", "check_asked", "gap_between"]

PointT = TypeVar("PointT")


@dataclass(frozen=True)
class Standing:
    """What is known at a time.

    Attributes:
        seconds: since the start, that of earlier runs included.
        value: the best that was found; infinite where the least friction is asked for and no points are
            known.
        bound: what is proved: no friction below it is enough, or no larger load is carried.
        gap: see `gap_between`.
    """

    seconds: float
    value: float
    bound: float
    gap: float


def gap_between(lower: float, upper: float, *, nothing: float) -> float:
    """How far value and bound are from each other, as a share of the upper one.

    Args:
        lower: the smaller of the two.
        upper: the larger; infinite where nothing is known of it.
        nothing: an upper one no larger than this leaves no gap.
    """
    if upper <= nothing:
        return 0.0
    return 1.0 if np.isinf(upper) else 1.0 - lower / upper


def check_asked(gap: float, budget_s: float, seed: int) -> tuple[float, float, int]:
    """These, as numbers that can be used.

    Raises:
        InputError: one can't.
    """
    gap = check_number("gap", gap, above=0.0)
    if gap >= 1.0:
        raise InputError("gap", "", f"must be a share below 1, not {gap:g}")
    return gap, check_budget("budget_s", budget_s), check_whole_number("seed", seed, least=0)


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
