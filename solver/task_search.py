"""The search for configurations of a task: what is known so far, and what the next slices should be like."""

import time
from collections.abc import Callable, Generator
from pathlib import Path

import numpy as np

from ..errors import InputError
from .box_worker import BoxWorker, Setup, SliceResult
from .checkpoint import fingerprint, read_checkpoint, write_checkpoint
from .configuration import Configuration
from .dispatcher import Dispatcher
from .proof import ProofWriter
from .prune import Box
from .search import Part, SearchOrder, SearchState, Slice, begin_at, search
from .spread import SHIFT_M, distance
from .state import State

__all__ = ["TaskSearch"]

# Configurations nearer to each other than this (see `distance`) count as one.
_DISTINCT = 0.1
# Inputs that get bounds from linear programs, the widest first: by the measurements of docs/solver.md.
_TIGHTENED = 5
# Fewer where Newton's method starts from each program's point: more boxes help it sooner than narrower ones.
_TIGHTENED_PURELY = 2
# Linear programs come in where less than this share of the local searches lands.
_LANDING_SHARE = 0.125
# A young tree is searched box by box. As it grows slices get larger, the sooner the cheaper a box is, so that
# handing them to another process is worth while; and more of them may be under way, fewer of them where
# depth comes first. No number here depends on how many processes there are.
_LARGEST_SLICE, _BOXES_PER_SIZE = 16, 16
_LARGEST_LP_SLICE, _BOXES_PER_LP_SIZE = 4, 64
_MOST_AHEAD, _BOXES_PER_SLICE_AHEAD, _BOXES_PER_SLICE_AHEAD_DEPTH_FIRST = 64, 4, 16
# Checkpoints are this far apart, and take at most a twentieth of the time.
_CHECKPOINT_S = 2.0


class TaskSearch:
    """A search that can be looked at between its steps.

    Args:
        setup: what is searched.
        workers: processes to use.
        proof: file for the proof log.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.
        worker: works on the boxes here; made from `setup` unless given.

    Attributes:
        state: of branch and prune.
        lps: linear programs solved.
        covered: where the solution set is to be covered, small boxes with a certified configuration inside.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: the checkpoint exists without `resume`, is damaged, or belongs to another search; a
            checkpoint together with a proof; a file that can't be written.
    """

    def __init__(
        self,
        setup: Setup,
        *,
        workers: int = 1,
        proof: str | Path | None = None,
        checkpoint: str | Path | None = None,
        resume: bool = False,
        worker: BoxWorker | None = None,
    ):
        self._started = time.perf_counter()
        self.setup = setup
        self.worker = worker or BoxWorker(setup)
        self.state: SearchState[Box, Configuration] = begin_at(
            [self.worker.root], setup.order, self.worker.key
        )
        self.lps = self.abandoned = self._probes = self._landed = 0
        self.covered: list[Box] = []
        self._earlier_s = 0.0
        self._found = _DistinctStates()
        self._workers = workers
        self._proof = ProofWriter(proof, self.worker.form, setup.task.name) if proof is not None else None
        self._checkpoint = _Checkpoint(Path(checkpoint), self) if checkpoint is not None else None
        if self._checkpoint is not None:
            if proof is not None:
                raise InputError(self._checkpoint.path, "", "a proof can't be combined with a checkpoint")
            self._checkpoint.open(resume)

    @property
    def seconds(self) -> float:
        """Time since the start, that of earlier runs of a resumed search included."""
        return self._earlier_s + self.seconds_here

    @property
    def seconds_here(self) -> float:
        """Time since the start, without earlier runs."""
        return time.perf_counter() - self._started

    @property
    def is_refuted(self) -> bool:
        """Whether every box was proved empty."""
        return not (self.state.n_open or self.state.undecided or self.state.solutions)

    def run(self) -> Generator["TaskSearch", None, None]:
        """Goes on; yields itself after each step until nothing is open."""
        dispatcher = Dispatcher(self.worker, self._workers)

        def begin(one: Slice[Box]) -> Callable[[], Part[Box, Configuration]]:
            wait = dispatcher.begin(one)
            return lambda: self._take_in(wait())

        try:
            for _ in search(self.state, self._cut, begin, self._lookahead):
                if self._checkpoint is not None:
                    self._checkpoint.write_in_time()
                yield self
            if self._proof is not None and self.is_refuted:
                self._proof.finish()
        finally:
            dispatcher.close()
            if self._checkpoint is not None:
                self._checkpoint.write()

    @property
    def counters(self) -> dict[str, float]:
        """What a checkpoint keeps besides the state."""
        return {
            "lps": self.lps,
            "abandoned": self.abandoned,
            "probes": self._probes,
            "landed": self._landed,
            "seconds": self.seconds,
        }

    def restore(self, counters: dict[str, float], covered: list[Box]) -> None:
        """Takes up where a checkpoint was written; `state` has been restored."""
        self.covered = covered
        self.lps, self.abandoned = int(counters["lps"]), int(counters["abandoned"])
        self._probes, self._landed = int(counters["probes"]), int(counters["landed"])
        self._earlier_s = float(counters["seconds"])
        for configuration in self.state.solutions:
            self._found.add(configuration.state)

    def _cut(self, depth: int, box: Box) -> Slice[Box]:
        effort, boxes = self._effort(), self.state.processed
        size = min(boxes // _BOXES_PER_SIZE, _LARGEST_SLICE)
        if effort:
            size = min(boxes // _BOXES_PER_LP_SIZE, _LARGEST_LP_SLICE)
        return Slice(box, depth, max(size, 1), effort)

    def _lookahead(self) -> int:
        """How many slices may be under way: one on the way down to a known solution, which is short."""
        ahead = [one.region for one in self.state.ahead] + [entry[3] for entry in self.state.frontier[:1]]
        if any(box.witness is not None for box in ahead):
            return 1
        depth_first = self.setup.order is SearchOrder.DEPTH_FIRST
        boxes = _BOXES_PER_SLICE_AHEAD_DEPTH_FIRST if depth_first else _BOXES_PER_SLICE_AHEAD
        return min(self.state.processed // boxes, _MOST_AHEAD)

    def _effort(self) -> int:
        """How many inputs to tighten by linear programs in the next slice.

        While enough local searches land, the tree serves only to spread the starts, and propagation at
        a hundredth of the cost does that as well.
        """
        if self.setup.cover or (not self.setup.pure and self._landed >= _LANDING_SHARE * self._probes):
            return 0
        return _TIGHTENED_PURELY if self.setup.pure else _TIGHTENED

    def _take_in(self, result: SliceResult) -> Part[Box, Configuration]:
        """Adds what became of a slice to what is known; configurations near known ones are left out."""
        self.lps += result.lps
        self._probes += result.probes
        self._landed += result.landed
        self.abandoned += result.abandoned
        if self._proof is not None:
            for record in result.records:
                self._proof.add(record)
        part = result.part
        self.covered += result.covered
        if not self.setup.cover:
            part.solutions = [c for c in part.solutions if self._found.add(c.state)]
        return part


class _Checkpoint:
    """The file of a search."""

    def __init__(self, path: Path, owner: TaskSearch):
        self.path = path
        self._search = owner
        self._key = fingerprint(owner.worker)
        self._next_s = 0.0

    def open(self, resume: bool) -> None:
        """Reads the file where there is one to go on from; else writes it, to see that that is possible."""
        if self.path.exists():
            if not resume:
                hint = "exists; resume it, or delete it to begin anew"
                raise InputError(self.path, "", hint)
            owner = self._search
            owner.restore(*read_checkpoint(self.path, self._key, owner.state, owner.worker))
        else:
            try:
                self.write()
            except OSError as error:
                raise InputError(self.path, "", error.strerror or "can't be written") from None

    def write_in_time(self) -> None:
        """Writes if the last time is long enough ago."""
        if time.perf_counter() >= self._next_s:
            self.write()

    def write(self) -> None:
        """Writes where the search stands."""
        begun = time.perf_counter()
        owner = self._search
        write_checkpoint(self.path, self._key, owner.state, owner.counters, owner.covered)
        ended = time.perf_counter()
        self._next_s = ended + max(_CHECKPOINT_S, 20.0 * (ended - begun))


class _DistinctStates:
    """States no two of which are nearer than `_DISTINCT`; arrays of joints and positions sort most out."""

    def __init__(self) -> None:
        self._states: list[State] = []
        self._rows = np.zeros((0, 0))

    def add(self, state: State) -> bool:
        """Keeps a state unless one is near; whether it was kept."""
        row = np.concatenate([state.q, state.p_palm_object / SHIFT_M])
        if self._states:
            near = np.flatnonzero(np.abs(self._rows[: len(self._states)] - row).max(axis=1) < _DISTINCT)
            if any(distance(state, self._states[i]) < _DISTINCT for i in near):
                return False
        if len(self._states) == len(self._rows):
            more = np.zeros((len(self._rows) + 16, len(row)))
            self._rows = np.vstack([self._rows.reshape(-1, len(row)), more])
        self._rows[len(self._states)] = row
        self._states.append(state)
        return True
