"""All solutions of a task: one by one where they are isolated, else as boxes that cover them."""

import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InputError
from ...objects import Task
from ..contacts import Certificate, Configuration
from ..contraction import Box
from ..enclosure import StraightLineProgram
from ..search import SearchOrder
from ..systems import IsolationVerdict
from .certify import TaskCertifier
from .isolate import is_square, isolate_inputs
from .search import TaskSearch
from .solve import Progress
from .worker import BoxWorker, Setup

__all__ = ["Cover", "CoverBox", "solve_all"]


@dataclass(frozen=True, eq=False)
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


@dataclass(frozen=True, eq=False)
class Cover:
    """The outcome of `solve_all`.

    Attributes:
        task: the task.
        verdict: COMPLETE, where solutions are isolated: `configurations` are all of them, each proved to be
            the only one in its certificate's box. COMPLETE, where they are not: every solution lies in one of
            `boxes`, none of which is wider than sigma, and some are certified. INFEASIBLE: proved that there
            is none. UNDECIDED: neither; still every solution lies in one of `boxes`.
        isolated: whether solutions are isolated.
        configurations: certified configurations, one for each certified box.
        names: (n_inputs,) of the inputs.
        boxes: the cover, certified boxes first; empty where solutions are isolated.
        undecided_boxes: boxes that were neither refuted nor certified.
        open_boxes: boxes that were left where the search stopped early.
        decided: share of the initial box that is decided, by number of splits.
        processed: boxes processed.
        lps: linear programs solved.
        seconds: time taken.
        sigma: width below which a box is not split.
    """

    task: Task
    verdict: IsolationVerdict
    isolated: bool
    configurations: tuple[Configuration, ...]
    names: tuple[str, ...]
    boxes: tuple[CoverBox, ...]
    undecided_boxes: int
    open_boxes: int
    decided: float
    processed: int
    lps: int
    seconds: float
    sigma: float

    @property
    def certified_boxes(self) -> int:
        """Boxes in which a solution is proved."""
        return len(self.configurations)


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
) -> Cover:
    """Finds all solutions of a task.

    Args:
        task: the task; where its object is fixed, solutions may be isolated.
        sigma: boxes with all inputs narrower than this are not split; see `iterate`.
        budget_s: time after which the search stops.
        workers: processes to use; their number has no influence on the result.
        checkpoint: see `iterate`.
        resume: see `iterate`.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: see `TaskSearch`; or a checkpoint where solutions are isolated.
    """
    started = time.perf_counter()
    certifier = TaskCertifier(task)
    if is_square(certifier.formulation.system):
        if checkpoint is not None:
            raise InputError(checkpoint, "", "isolated solutions are found without a checkpoint")
        return _isolated(certifier, sigma, started, budget_s, workers, should_stop)
    setup = Setup(task, sigma, 0, pure=True, order=SearchOrder.DEPTH_FIRST, cover=True)
    worker = BoxWorker(setup, certifier)
    search = TaskSearch(setup, workers=workers, checkpoint=checkpoint, resume=resume, worker=worker)
    with closing(search.run()) as steps:
        for _ in steps:
            if on_progress is not None:
                on_progress(Progress.of(search))
            if search.seconds_here > budget_s or (should_stop is not None and should_stop()):
                break
    return _covered(search)


def _covered(search: TaskSearch) -> Cover:
    state, inputs = search.state, search.worker.inputs
    left = state.undecided + state.open_regions
    if not left and not search.covered:
        verdict = IsolationVerdict.INFEASIBLE
    else:
        done = search.covered and not state.n_open
        verdict = IsolationVerdict.COMPLETE if done else IsolationVerdict.UNDECIDED

    def boxes(group: list[Box], certified: bool) -> list[CoverBox]:
        return [CoverBox(box.lower[inputs], box.upper[inputs], certified) for box in group]

    names = search.worker.formulation.system.names
    return Cover(
        search.setup.task,
        verdict,
        False,
        tuple(state.solutions),
        tuple(names[i] for i in inputs),
        tuple(boxes(search.covered, True) + boxes(left, False)),
        len(state.undecided),
        state.n_open,
        state.decided,
        state.processed,
        search.lps,
        search.seconds,
        search.setup.sigma,
    )


def _isolated(
    certifier: TaskCertifier,
    sigma: float,
    started: float,
    budget_s: float,
    workers: int,
    should_stop: Callable[[], bool] | None,
) -> Cover:
    system = certifier.formulation.system
    found = isolate_inputs(system, budget_s=budget_s, workers=workers, should_stop=should_stop)
    program = StraightLineProgram(system)
    return Cover(
        certifier.task,
        found.verdict,
        True,
        tuple(_configuration(certifier, program, *box) for box in found.boxes),
        tuple(system.names[i] for i in system.inputs),
        (),
        found.n_undecided,
        0,
        1.0 if found.verdict is not IsolationVerdict.UNDECIDED else 0.0,
        found.processed,
        0,
        time.perf_counter() - started,
        sigma,
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
    certificate = Certificate(names, enclosure.lower, enclosure.upper, ())
    return Configuration(certifier.task, state, residual_m, certificate)
