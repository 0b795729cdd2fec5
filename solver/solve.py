"""Solving a task: distinct certified configurations, or a proof that there are none."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..geometry.transforms import rotation_angle
from ..objects import Task
from .canonical import canonical_form
from .certify import TaskCertifier
from .configuration import Configuration
from .local_search import search_locally
from .proof import BoxTrace, ProofWriter
from .prune import Box, Pruner
from .search import Outcome, SearchOrder, SearchState, branch_and_prune
from .state import State

__all__ = ["Progress", "SolveResult", "Verdict", "distance", "solve"]

Array = NDArray[np.float64]
# Configurations nearer to each other than this (see `distance`) count as one.
_DISTINCT = 0.1
# Inputs that get bounds from linear programs, the widest first: by the measurements of docs/solver.md.
_TIGHTENED = 5
# Local searches from the first box, each some 5 ms: where one lands, no linear program is needed.
_FIRST_STARTS = 16
# Linear programs come in where less than this share of the local searches lands.
_LANDING_SHARE = 0.125


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
        decided: share of the initial box that is decided, by number of splits.
        found: certified configurations so far.
        seconds: time since the start.
    """

    boxes: int
    open_boxes: int
    decided: float
    found: int
    seconds: float


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

    @property
    def spread(self) -> dict[str, float] | None:
        """Smallest and median distance from a configuration to its nearest neighbour; None below two."""
        if len(self.configurations) < 2:
            return None
        nearest = [
            min(distance(a.state, b.state) for b in self.configurations if b is not a)
            for a in self.configurations
        ]
        return {"smallest": float(min(nearest)), "median": float(np.median(nearest))}


def distance(a: State, b: State) -> float:
    """How far two states are apart: the largest of joint difference (rad), turn (rad) and shift / 0.1 m."""
    joints = float(np.abs(a.q - b.q).max(initial=0.0))
    turn = rotation_angle(a.R_palm_object.T @ b.R_palm_object)
    shift = float(np.linalg.norm(a.p_palm_object - b.p_palm_object)) / 0.1
    return max(joints, turn, shift)


def solve(
    task: Task,
    *,
    candidates: int = 16,
    seed: int = 0,
    sigma: float = 0.1,
    budget_s: float = 60.0,
    pure: bool = False,
    proof: str | Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> SolveResult:
    """Searches the whole space of a task for certified configurations.

    Args:
        task: the task.
        candidates: how many distinct configurations to look for.
        seed: the same seed gives the same result, unless the budget ends the search.
        sigma: boxes with all inputs narrower than this are not split; in units of `UNIT_M` for lengths, 1
            for cosines, sines and patch parameters.
        budget_s: time after which the search stops.
        pure: branch and prune alone, depth first: no local search from boxes that can still be split.
        proof: file for the proof log (see `check_proof`), written only where the verdict is INFEASIBLE.
        on_progress: called after each box.
        should_stop: asked after each box; the search stops where it answers True.
    """
    started = time.perf_counter()
    search = _TaskSearch(task, sigma, seed, pure=pure, proof=proof)
    order = SearchOrder.DEPTH_FIRST if pure else SearchOrder.BREADTH_FIRST
    state: SearchState[Box, Configuration] = SearchState()
    for state in branch_and_prune([search.pruner.root], search.process, order):
        seconds = time.perf_counter() - started
        if on_progress is not None:
            on_progress(
                Progress(state.processed, len(state.frontier), state.decided, len(state.solutions), seconds)
            )
        if len(state.solutions) >= candidates or seconds > budget_s or (should_stop and should_stop()):
            break
    if state.solutions:
        verdict = Verdict.SOLVED
    elif state.frontier or state.undecided:
        verdict = Verdict.UNDECIDED
    else:
        verdict = Verdict.INFEASIBLE
        if search.proof is not None:
            search.proof.finish()
    return SolveResult(
        task,
        verdict,
        tuple(state.solutions[:candidates]),
        state.processed,
        len(state.undecided),
        len(state.frontier),
        search.pruner.lps,
        time.perf_counter() - started,
        sigma,
        seed,
    )


class _DistinctStates:
    """States no two of which are nearer than `_DISTINCT`; arrays of joints and positions sort most out."""

    def __init__(self) -> None:
        self._states: list[State] = []
        self._rows = np.zeros((0, 0))

    def add(self, state: State) -> bool:
        """Keeps a state unless one is near; whether it was kept."""
        row = np.concatenate([state.q, state.p_palm_object / 0.1])
        if self._states:
            near = np.flatnonzero(np.abs(self._rows[: len(self._states)] - row).max(axis=1) < _DISTINCT)
            if any(distance(state, self._states[i]) < _DISTINCT for i in near):
                return False
        if len(self._states) == len(self._rows):
            self._rows = np.vstack(
                [self._rows.reshape(-1, len(row)), np.zeros((len(self._rows) + 16, len(row)))]
            )
        self._rows[len(self._states)] = row
        self._states.append(state)
        return True


class _TaskSearch:
    """What branch and prune does with a box of a task's system."""

    def __init__(self, task: Task, sigma: float, seed: int, *, pure: bool, proof: str | Path | None = None):
        self.certifier = TaskCertifier(task)
        self.formulation = self.certifier.formulation
        self.pruner = Pruner(canonical_form(self.formulation.system), self.formulation.system.inputs)
        self.sigma = sigma
        self.pure = pure
        self.proof = ProofWriter(proof, self.pruner.form, task.name) if proof is not None else None
        self._rng = np.random.default_rng(seed)
        self._found = _DistinctStates()
        self._probes = 0
        self._landed = 0

    def process(self, box: Box) -> Outcome[Box, Configuration]:
        """Prunes a box, looks for a configuration from within it, and splits it."""
        trace = self.proof.trace() if self.proof is not None else None
        pruned = self.pruner.prune(box, tightened=self._effort(), trace=trace)
        if pruned is None:
            self._record(box, trace, None)
            return Outcome()
        inputs = self.formulation.system.inputs
        small = bool(np.all((pruned.upper - pruned.lower)[inputs] <= self.sigma))
        found = [] if self.pure and not small else self._probe(pruned)
        if not small:
            self._record(box, trace, pruned)
            return Outcome(found, self.pruner.split(pruned))
        # A certified configuration inside a small box stands for the box; otherwise it stays undecided.
        return Outcome(found) if found else Outcome(undecided=pruned)

    def _record(self, box: Box, trace: BoxTrace | None, left: Box | None) -> None:
        """Adds a box to the proof log, where one is kept: split where `left` is cut, or empty."""
        if self.proof is not None and trace is not None:
            self.proof.add(box.path, trace, self.pruner.cut(left) if left is not None else None)

    def _effort(self) -> int:
        """How many inputs to tighten by linear programs in the next box.

        While enough local searches land, the tree serves only to spread the starts, and propagation at
        a hundredth of the cost does that as well.
        """
        if not self.pure and self._landed >= _LANDING_SHARE * self._probes:
            return 0
        return _TIGHTENED

    def _probe(self, box: Box) -> list[Configuration]:
        """At most one new certified configuration, by local searches from points of the box."""
        for _ in range(1 if self._probes else _FIRST_STARTS):
            found = self._probe_once(box)
            if found:
                return found
        return []

    def _probe_once(self, box: Box) -> list[Configuration]:
        """At most one new certified configuration, by a local search from a point of the box."""
        start = self._start(box)
        reached = search_locally(self.certifier.manifold, start)
        self._probes += 1
        if reached is None:
            return []
        self._landed += 1
        configuration = self.certifier.certify(reached)
        if not configuration.certified:
            return []
        return [configuration] if self._found.add(configuration.state) else []

    def _start(self, box: Box) -> State:
        """A state in the box: random in joints and parameters, near the LP's point in the pose."""
        x = self._rng.uniform(box.lower, np.maximum(box.upper, box.lower))
        if box.point is not None:
            pose = np.concatenate([self.formulation.rotation_inputs, self.formulation.position_inputs])
            x[pose] = 0.5 * (x[pose] + box.point[pose])
        return self.formulation.state_from_inputs(x, self.certifier.q_free)
