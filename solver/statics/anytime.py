"""The best value that is found, and the bound that is shown, as both come nearer to each other."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np

from ...arguments import check_budget, check_number, check_whole_number
from ...base.machine.cancellation import Cancelled, cancellable, give_up_if_asked
from ...base.text.plain_text import counted
from ...errors import InputError
from ..search import Progress, Stopwatch
from .search import StaticsSearch
from .worker import StaticsSetup

__all__ = ["NEXT_TO_NOTHING", "Anytime", "BestGrasp", "Standing", "climbs", "in_time"]

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


@dataclass(frozen=True, eq=False, kw_only=True)
class Anytime:
    """How a best grasp is searched for, whatever it is the best of.

    Numbers that can't be used raise an `InputError`.

    Attributes:
        gap: share at which value and bound are near enough.
        budget_s: time after which the search stops.
        seed: of the starts of local search.
        workers: processes to use.
        proof: file for the log of what is refuted.
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.
        watch: started with it.
    """

    gap: float
    budget_s: float
    seed: int
    workers: int
    proof: str | Path | None
    checkpoint: str | Path | None
    resume: bool
    on_progress: Callable[[Standing, Progress], None] | None
    should_stop: Callable[[], bool] | None
    watch: Stopwatch = field(default_factory=Stopwatch)

    def __post_init__(self) -> None:
        if check_number("gap", self.gap, above=0.0) >= 1.0:
            raise InputError("gap", "", f"must be a share below 1, not {self.gap:g}")
        check_budget("budget_s", self.budget_s)
        check_whole_number("seed", self.seed, least=0)

    def lateness(self, share: float) -> Callable[[], bool]:
        """What tells whether such a share of the time is over, or somebody wants no more."""
        asked = self.should_stop
        return lambda: self.watch.seconds_here > share * self.budget_s or (asked is not None and asked())

    def approach(
        self,
        setup: StaticsSetup[PointT],
        known: tuple[PointT, ...],
        standing: Callable[[StaticsSearch[PointT]], Standing],
        what: str = "",
    ) -> tuple[StaticsSearch[PointT], tuple[Standing, ...]]:
        """Searches until the gap is small enough, or the time is over.

        Args:
            setup: what is searched.
            known: points that are known before.
            standing: what a search has found and shown.
            what: tells it from other searches in a checkpoint, beside the setup.

        Returns:
            The search, and what was known when, as it changed.
        """
        search = StaticsSearch(
            setup,
            known=known,
            asked=f"{what}gap {self.gap}, seed {self.seed}",
            workers=self.workers,
            proof=self.proof,
            checkpoint=self.checkpoint,
            resume=self.resume,
            watch=self.watch,
        )
        history = [standing(search)]

        def enough() -> bool:
            now = standing(search)
            if (now.value, now.bound) != (history[-1].value, history[-1].bound):
                history.append(now)
            return now.gap <= self.gap

        def report(progress: Progress) -> None:
            if self.on_progress is not None:
                self.on_progress(standing(search), progress)

        search.finish(budget_s=self.budget_s, on_progress=report, should_stop=self.should_stop, enough=enough)
        return search, (*history, standing(search))


def climbs(climb: Callable[[], EndT], most: int, is_late: Callable[[], bool]) -> Iterator[EndT]:
    """Ends of so many local searches; once it is late no other begins, and one under way is given up.

    The first is made whatever the time: without a value nothing can be pruned, nor resumed later.
    """
    yield climb()
    for _ in range(most - 1):
        end = in_time(climb, is_late)
        if end is None:
            return
        yield end


def in_time(climb: Callable[[], EndT], is_late: Callable[[], bool]) -> EndT | None:
    """The end of a local search, or None once it is late."""
    try:
        with cancellable(is_late):
            give_up_if_asked()
            return climb()
    except Cancelled:
        return None
