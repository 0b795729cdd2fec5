"""All solutions of a task: one by one where they are isolated, else as boxes that cover them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import overload

import numpy as np

from ...arguments import check_budget, check_number, check_whole_number
from ...base.numeric.arrays import Array
from ...base.text.plain_text import counted
from ...errors import InputError
from ...objects import Task
from ..contacts import Certificate, Configuration, configurations_html
from ..contraction import Box
from ..enclosure import StraightLineProgram
from ..search import Progress, SearchOrder, SearchResult, Stopwatch, Verdict
from .certify import TaskCertifier
from .search import TaskSearch
from .solve import check_task
from .square import SquareSolutions, is_square, solve_square
from .worker import TaskSetup, TaskWorker

__all__ = ["CoverBox", "SolutionSet", "solve_all"]


@dataclass(frozen=True, eq=False, repr=False)
class CoverBox:
    """A box of the cover.

    Attributes:
        lower: (n_inputs,) of the inputs of the task's system.
        upper: (n_inputs,)
        certified: whether a true solution is proved to lie in it; else it may be empty.
    """

    lower: Array
    upper: Array
    certified: bool

    def __repr__(self) -> str:
        proof = "certified" if self.certified else "not certified"
        widest = float(np.max(self.upper - self.lower, initial=0.0))
        return f"<CoverBox {proof}, {self.lower.size} inputs, at most {widest:.3g} wide>"


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SolutionSet(SearchResult):
    """The outcome of `solve_all`: a sequence of configurations, and what else became known.

    Attributes:
        verdict: COMPLETE, where solutions are isolated: `configurations` are all of them, each proved to be
            the only one in its certificate's box. COMPLETE, where they are not: every solution lies in one of
            the boxes of `cover`, none of which is wider than sigma, and some are certified. INFEASIBLE:
            proved that there is none. UNDECIDED: neither; still every solution lies in one of the boxes.
        task: the task.
        isolated: whether solutions are isolated.
        configurations: certified configurations, one for each certified box.
        names: (n_inputs,) of the inputs.
        cover: boxes that hold all solutions, certified ones first; empty where solutions are isolated.
        lps: linear programs solved.
    """

    task: Task
    isolated: bool
    configurations: tuple[Configuration, ...]
    names: tuple[str, ...]
    cover: tuple[CoverBox, ...]
    lps: int

    @property
    def certified_boxes(self) -> int:
        """Boxes in which a solution is proved."""
        return len(self.configurations)

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
        if self.isolated:
            return self.summary(counted(len(self), "isolated solution"))
        return self.summary(f"a cover with {counted(len(self), 'certified box', 'certified boxes')}")

    def _repr_html_(self) -> str:
        return configurations_html(f"{self.task.name}: {self}", self.configurations)


def solve_all(
    task: Task,
    *,
    sigma: float = 0.1,
    budget_s: float = 60.0,
    workers: int = 1,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> SolutionSet:
    """Finds all solutions of a task.

    Args:
        task: the task; where its object is fixed, solutions may be isolated. Normals are exactly opposed, but
            at contacts that name another `align_within_deg`.
        sigma: boxes with all inputs narrower than this are not split; see `solve`.
        budget_s: time after which the search stops; `inf` for no limit.
        workers: processes to use; their number has no influence on the result.
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used; a checkpoint, see `TaskSearch`, or one where solutions are
            isolated.
    """
    sigma, budget_s = check_number("sigma", sigma, above=0.0), check_budget("budget_s", budget_s)
    workers = check_whole_number("workers", workers, least=1)
    watch = Stopwatch()
    # Room for normals would give the solution set two more dimensions a contact.
    task = check_task(task).aligned_exactly(unless_asked=True)
    certifier = TaskCertifier(task)
    if is_square(certifier.formulation.system):
        if checkpoint is not None:
            raise InputError(checkpoint, "", "isolated solutions are found without a checkpoint")
        system = certifier.formulation.system
        found = solve_square(system, budget_s=budget_s, workers=workers, should_stop=should_stop)
        return _isolated(certifier, found, sigma, watch)
    setup = TaskSetup(task=task, sigma=sigma, seed=0, pure=True, order=SearchOrder.DEPTH_FIRST, cover=True)
    worker = TaskWorker(setup, certifier)
    search = TaskSearch(setup, workers=workers, checkpoint=checkpoint, resume=resume, worker=worker)
    search.finish(budget_s=budget_s, should_stop=should_stop, on_progress=on_progress)
    return _covered(search)


def _covered(search: TaskSearch) -> SolutionSet:
    state, inputs = search.state, search.worker.inputs
    left = state.undecided + state.open_regions
    if not left and not search.covered:
        verdict = Verdict.INFEASIBLE
    else:
        verdict = Verdict.COMPLETE if search.covered and not state.n_open else Verdict.UNDECIDED

    def boxes(group: list[Box], certified: bool) -> list[CoverBox]:
        return [CoverBox(box.lower[inputs], box.upper[inputs], certified) for box in group]

    names = search.worker.formulation.system.names
    return SolutionSet(
        verdict=verdict,
        progress=search.progress,
        sigma=search.setup.sigma,
        abandoned=search.abandoned,
        task=search.setup.task,
        isolated=False,
        configurations=tuple(state.solutions),
        names=tuple(names[i] for i in inputs),
        cover=tuple(boxes(search.covered, True) + boxes(left, False)),
        lps=search.lps,
    )


def _isolated(
    certifier: TaskCertifier, found: SquareSolutions, sigma: float, watch: Stopwatch
) -> SolutionSet:
    system = certifier.formulation.system
    program = StraightLineProgram(system)
    configurations = tuple(_configuration(certifier, program, *box) for box in found.boxes)
    return SolutionSet(
        verdict=found.verdict,
        progress=Progress(
            boxes=found.processed,
            open=0,
            found=len(configurations),
            undecided=found.n_undecided,
            depth=found.depth,
            decided=1.0 if found.verdict is not Verdict.UNDECIDED else 0.0,
            seconds=watch.seconds,
        ),
        sigma=sigma,
        task=certifier.task,
        isolated=True,
        configurations=configurations,
        names=tuple(system.names[i] for i in system.inputs),
        cover=(),
        lps=0,
    )


def _configuration(
    certifier: TaskCertifier, program: StraightLineProgram, lower: Array, upper: Array
) -> Configuration:
    """The configuration whose solution is the only one in a box."""
    enclosure = program.enclose(lower, upper)
    middle = 0.5 * (enclosure.lower + enclosure.upper)
    state = certifier.formulation.state_from_inputs(middle, certifier.q_free)
    residual_m = float(np.abs(certifier.manifold.residual(state)).max())
    names = certifier.formulation.system.names
    opposed = certifier.opposed_within(enclosure.lower, enclosure.upper)
    certificate = Certificate(names, enclosure.lower, enclosure.upper, (), opposed)
    return Configuration(certifier.task, state, residual_m, certificate)
