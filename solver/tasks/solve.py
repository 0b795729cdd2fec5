"""Solving a task: distinct certified configurations, or a proof that there are none."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

from ...objects import Task
from ..contacts import Configuration, distance, spread, spread_out
from ..search import SearchOrder
from .search import TaskSearch
from .worker import Setup

__all__ = ["Progress", "SolveResult", "Verdict", "distance", "iterate", "solve"]

# Configurations among which one that is far from the others is chosen.
_CHOICE = 4


class Verdict(Enum):
    """How solving ended."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Progress:
    """What a running solve reports.

    Attributes:
        boxes: boxes processed.
        open_boxes: boxes still to be processed.
        depth: splits above the deepest box.
        decided: share of the initial box that is decided, by number of splits.
        found: certified configurations so far.
        seconds: time since the start.
    """

    boxes: int
    open_boxes: int
    depth: int
    decided: float
    found: int
    seconds: float

    @classmethod
    def of(cls, search: TaskSearch) -> "Progress":
        """Where a search stands."""
        state = search.state
        return cls(
            state.processed,
            state.n_open,
            state.depth,
            state.decided,
            len(state.solutions),
            search.seconds,
        )


@dataclass(frozen=True, eq=False)
class SolveResult:
    """The outcome of `solve`.

    Attributes:
        task: the task.
        verdict: SOLVED where a certified configuration was found; INFEASIBLE only where every box of the
            search was proved empty; else UNDECIDED.
        configurations: distinct certified configurations, in the order in which they were found.
        boxes: boxes processed.
        undecided_boxes: boxes below sigma that could neither be refuted nor certified.
        open_boxes: boxes left where the search stopped early.
        lps: linear programs solved.
        seconds: time taken.
        sigma: width, in the system's units, below which a box is not split.
        seed: seed of the local search's starts.
        abandoned_boxes: those of the undecided boxes that were given up because every process that worked on
            them died.
    """

    task: Task
    verdict: Verdict
    configurations: tuple[Configuration, ...]
    boxes: int
    undecided_boxes: int
    open_boxes: int
    lps: int
    seconds: float
    sigma: float
    seed: int
    abandoned_boxes: int = 0

    @classmethod
    def of(cls, search: TaskSearch, candidates: int | None = None) -> "SolveResult":
        """What a search has found so far, with at most so many configurations."""
        state = search.state
        verdict = Verdict.INFEASIBLE if search.is_refuted else Verdict.UNDECIDED
        return cls(
            search.setup.task,
            Verdict.SOLVED if state.solutions else verdict,
            tuple(state.solutions[:candidates]),
            state.processed,
            len(state.undecided),
            state.n_open,
            search.lps,
            search.seconds,
            search.setup.sigma,
            search.setup.seed,
            search.abandoned,
        )

    @property
    def spread(self) -> dict[str, float] | None:
        """How far configurations are from their nearest neighbours (see `spread.spread`); None below two."""
        return spread(self.configurations)


def iterate(
    task: Task,
    *,
    seed: int = 0,
    sigma: float = 0.1,
    pure: bool = False,
    order: SearchOrder | None = None,
    workers: int = 1,
    proof: str | Path | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
) -> Generator[TaskSearch, None, None]:
    """The search of a task, step by step; leave it whenever you have seen enough.

    The same search is yielded after each step, a box or a few: its `state` has all that was found, and
    `Progress.of` and `SolveResult.of` sum it up. Close the iterator, or let go of it, to end its processes.

    Args:
        task: the task.
        seed: the same seed gives the same states, whatever the number of workers.
        sigma: boxes with all inputs narrower than this are not split; in units of `UNIT_M` for lengths, 1
            for cosines, sines and patch parameters.
        pure: branch and prune alone: no local search from boxes that can still be split.
        order: which box comes next; breadth first unless given, or depth first where `pure`.
        workers: processes to use, once the search has turned out to take longer than they need to start.
        proof: file for the proof log (see `check_proof`), written only where the task is infeasible.
        checkpoint: file to which the search is written every few seconds and when it is left.
        resume: go on from that file, if there is one.

    Raises:
        InputError: see `TaskSearch`.
    """
    setup = _setup(task, sigma, seed, pure, order, proof)
    return TaskSearch(setup, workers=workers, proof=proof, checkpoint=checkpoint, resume=resume).run()


def _setup(
    task: Task, sigma: float, seed: int, pure: bool, order: SearchOrder | None, proof: str | Path | None
) -> Setup:
    usual = SearchOrder.DEPTH_FIRST if pure else SearchOrder.BREADTH_FIRST
    return Setup(task, sigma, seed, pure, order or usual, traced=proof is not None)


def solve(
    task: Task,
    *,
    candidates: int = 16,
    spread_apart: bool = False,
    seed: int = 0,
    sigma: float = 0.1,
    budget_s: float = 60.0,
    pure: bool = False,
    order: SearchOrder | None = None,
    workers: int = 1,
    proof: str | Path | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> SolveResult:
    """Searches the whole space of a task for certified configurations.

    Args:
        task: the task.
        candidates: how many distinct configurations to look for.
        spread_apart: look for four times as many, and return those that are far apart (see `spread_out`).
        seed: the same seed gives the same result, unless the budget ends the search.
        sigma: see `iterate`, as for all that is not explained here.
        budget_s: time after which the search stops.
        pure: see `iterate`.
        order: see `iterate`.
        workers: see `iterate`; their number has no influence on the result.
        proof: see `iterate`.
        checkpoint: see `iterate`.
        resume: see `iterate`.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: see `TaskSearch`.
    """
    setup = _setup(task, sigma, seed, pure, order, proof)
    search = TaskSearch(setup, workers=workers, proof=proof, checkpoint=checkpoint, resume=resume)
    wanted = _CHOICE * candidates if spread_apart else candidates
    if len(search.state.solutions) < wanted:
        with closing(search.run()) as steps:
            for _ in steps:
                if on_progress is not None:
                    on_progress(Progress.of(search))
                enough = len(search.state.solutions) >= wanted
                if enough or search.seconds_here > budget_s or (should_stop is not None and should_stop()):
                    break
    result = SolveResult.of(search, wanted)
    return replace(result, configurations=tuple(spread_out(result.configurations, candidates)))
