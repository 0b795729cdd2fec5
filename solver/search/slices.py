"""The steps of a search in slices: worked on here or in other processes, with its state kept in a file."""

import time
from collections.abc import Callable, Generator
from typing import TypeVar

from ...workers import Worker, WorkerSetup
from .branch_and_prune import Part, SearchState, Slice, search
from .checkpoint import Checkpoint
from .dispatcher import Dispatcher

__all__ = ["Stopwatch", "run_slices"]

RegionT = TypeVar("RegionT")
SolutionT = TypeVar("SolutionT")
JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")


class Stopwatch:
    """The time that a search takes, in one run or several.

    Attributes:
        earlier_s: time of earlier runs.
    """

    def __init__(self) -> None:
        self._started = time.perf_counter()
        self.earlier_s = 0.0

    @property
    def seconds_here(self) -> float:
        """Time since the start, without earlier runs."""
        return time.perf_counter() - self._started

    @property
    def seconds(self) -> float:
        """Time since the start, that of earlier runs included."""
        return self.earlier_s + self.seconds_here


def run_slices(
    state: SearchState[RegionT, SolutionT],
    setup: WorkerSetup[JobT, ResultT],
    worker: Worker[JobT, ResultT],
    workers: int,
    checkpoint: Checkpoint | None,
    *,
    cut: Callable[[int, RegionT], Slice[RegionT]],
    job: Callable[[Slice[RegionT]], JobT],
    take_in: Callable[[ResultT], Part[RegionT, SolutionT]],
    lookahead: Callable[[], int],
) -> Generator[SearchState[RegionT, SolutionT], None, None]:
    """Yields the state after each slice; closing the iterator ends all processes.

    Args:
        state: where to begin.
        setup: what further workers are made from.
        worker: works on slices here.
        workers: processes to use, once the search takes longer than they need to start.
        checkpoint: where the search is written every few seconds and when it ends or is left.
        cut: see `search`.
        job: what is handed to a worker for a slice.
        take_in: what a worker's result adds to the state.
        lookahead: see `search`.
    """
    dispatcher = Dispatcher(setup, worker, workers)

    def begin(one: Slice[RegionT]) -> Callable[[], Part[RegionT, SolutionT]]:
        wait = dispatcher.begin(job(one))
        return lambda: take_in(wait())

    try:
        for now in search(state, cut, begin, lookahead):
            if checkpoint is not None:
                checkpoint.write_in_time()
            yield now
    finally:
        dispatcher.close()
        if checkpoint is not None:
            checkpoint.write()
