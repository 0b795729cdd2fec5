"""Solving a task: distinct certified configurations, or a proof that there are none."""

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, overload

from ...arguments import check_budget, check_instance, check_number, check_whole_number
from ...base.text.plain_text import counted
from ...objects import Task
from ..contacts import Configuration, configurations_html, spread, spread_out
from ..search import Progress, SearchOrder, SearchResult, Verdict, check_order
from ..statics import StaticsResult, refute_balance, why_not
from .search import TaskSearch
from .worker import TaskSetup

__all__ = ["SolveResult", "check_task", "iterate", "solve"]

# Configurations among which one that is far from the others is chosen.
_CHOICE = 4
# Share of the budget that statics of the regions may take.
_STATICS_SHARE = 0.05

SolveVerdict = Literal[Verdict.SOLVED, Verdict.INFEASIBLE, Verdict.UNDECIDED]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SolveResult(SearchResult):
    """The outcome of `solve`: a sequence of configurations, and what else became known.

    Attributes:
        task: the task.
        verdict: SOLVED where a certified configuration was found; INFEASIBLE only where every box of the
            search was proved empty; else UNDECIDED.
        configurations: distinct certified configurations, in the order in which they were found.
        lps: linear programs solved.
        seed: seed of the local search's starts.
        statics: what statics of the regions has shown, where it was asked for and applies to the task. Where
            it refutes that they can hold the load, the verdict is INFEASIBLE for that reason, and no
            configuration was looked for.
    """

    verdict: SolveVerdict
    task: Task
    configurations: tuple[Configuration, ...]
    lps: int
    seed: int
    statics: StaticsResult | None = None

    @classmethod
    def of(cls, search: TaskSearch, candidates: int | None = None) -> "SolveResult":
        """What a search has found so far, with at most so many configurations."""
        found = search.state.solutions
        return cls(
            verdict=_verdict(search),
            progress=search.progress,
            sigma=search.setup.sigma,
            abandoned=search.abandoned,
            task=search.setup.task,
            configurations=tuple(found[:candidates]),
            lps=search.lps,
            seed=search.setup.seed,
        )

    @classmethod
    def without_friction(cls, task: Task, statics: StaticsResult, sigma: float, seed: int) -> "SolveResult":
        """Infeasible, for the regions can't hold the load."""
        return cls(
            verdict=Verdict.INFEASIBLE,
            progress=statics.progress,
            sigma=sigma,
            task=task,
            configurations=(),
            lps=0,
            seed=seed,
            statics=statics,
        )

    @property
    def lacks_friction(self) -> bool:
        """Whether it is infeasible because no forces at its regions can hold the load."""
        return self.statics is not None and self.statics.verdict is Verdict.INFEASIBLE

    def __len__(self) -> int:
        return len(self.configurations)

    def __iter__(self) -> Iterator[Configuration]:
        return iter(self.configurations)

    @overload
    def __getitem__(self, index: int) -> Configuration: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Configuration, ...]: ...
    def __getitem__(self, index: int | slice) -> Configuration | tuple[Configuration, ...]:
        return self.configurations[index]

    def __str__(self) -> str:
        found = counted(len(self), "certified configuration")
        if self.lacks_friction:
            found = f"its regions can't hold the load with friction {self.task.object.friction:g}"
        return self.summary(found)

    def _repr_html_(self) -> str:
        return configurations_html(f"{self.task.name}: {self}", self.configurations)

    @property
    def spread(self) -> dict[str, float] | None:
        """How far configurations are from their nearest neighbours (see `spread.spread`); None below two."""
        return spread(self.configurations)


def _verdict(search: TaskSearch) -> SolveVerdict:
    if search.state.solutions:
        return Verdict.SOLVED
    return Verdict.INFEASIBLE if search.is_refuted else Verdict.UNDECIDED


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

    The same search is yielded after each step, a box or a few: its `state` has all that was found, its
    `progress` says where it stands, and `SolveResult.of` sums it up. Close the iterator, or let go of it, to
    end its processes.

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
        InputError: an argument that can't be used; a checkpoint or a file, see `TaskSearch`.
    """
    setup = _setup(task, seed, sigma, pure, order, traced=proof is not None)
    return TaskSearch(setup, workers=workers, proof=proof, checkpoint=checkpoint, resume=resume).run()


def solve(
    task: Task,
    *,
    candidates: int = 16,
    spread_apart: bool = False,
    seed: int = 0,
    sigma: float = 0.1,
    budget_s: float = 60.0,
    pure: bool = False,
    statics: bool = False,
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
        seed: the same seed gives the same result, whatever the number of workers, unless the budget ends the
            search.
        sigma: boxes with all inputs narrower than this are not split; in units of `UNIT_M` for lengths, 1
            for cosines, sines and patch parameters.
        budget_s: time after which the search stops; `inf` for no limit.
        pure: branch and prune alone: no local search from boxes that can still be split.
        statics: first try to prove that the object's regions can't hold the load with the object's friction,
            wherever in them contacts are and whatever the hand does, in a twentieth of the budget. That is
            about the named contacts as points (see `statics.problem`); tasks to which it doesn't apply are
            solved as without it.
        order: which box comes next; breadth first unless given, or depth first where `pure`.
        workers: processes to use, once the search has turned out to take longer than they need to start;
            their number has no influence on the result.
        proof: file for the proof log (see `check_proof`), written only where the task is infeasible.
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used; a checkpoint that exists without `resume`, is damaged, or
            belongs to another search; a checkpoint together with a proof; a file that can't be written.
    """
    candidates = check_whole_number("candidates", candidates, least=1)
    budget_s = check_budget("budget_s", budget_s)
    setup = _setup(task, seed, sigma, pure, order, traced=proof is not None)
    shown: StaticsResult | None = None
    if statics and not why_not(task):
        shown = refute_balance(
            task,
            budget_s=_STATICS_SHARE * budget_s,
            seed=seed,
            workers=workers,
            proof=proof,
            should_stop=should_stop,
        )
        budget_s -= shown.progress.seconds
        if shown.verdict is Verdict.INFEASIBLE:
            return SolveResult.without_friction(task, shown, setup.sigma, seed)
    search = TaskSearch(setup, workers=workers, proof=proof, checkpoint=checkpoint, resume=resume)
    wanted = _CHOICE * candidates if spread_apart else candidates
    search.finish(
        budget_s=budget_s,
        should_stop=should_stop,
        on_progress=on_progress,
        enough=lambda: len(search.state.solutions) >= wanted,
    )
    result = SolveResult.of(search, wanted)
    chosen = tuple(spread_out(result.configurations, candidates))
    return replace(result, configurations=chosen, statics=shown)


def _setup(
    task: Task, seed: int, sigma: float, pure: bool, order: SearchOrder | None, traced: bool
) -> TaskSetup:
    """What `iterate` and `solve` have in common, checked."""
    usual = SearchOrder.DEPTH_FIRST if pure else SearchOrder.BREADTH_FIRST
    return TaskSetup(
        task=check_task(task),
        sigma=check_number("sigma", sigma, above=0.0),
        seed=check_whole_number("seed", seed, least=0),
        pure=pure,
        order=usual if order is None else check_order(order),
        traced=traced,
    )


def check_task(task: Task) -> Task:
    """The task.

    Raises:
        InputError: it is none.
    """
    return check_instance("task", task, Task, "a Task, as `load_task` gives it")
