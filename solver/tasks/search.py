"""The search for configurations of a task: what is known so far, and what the next slices should be like."""

from collections.abc import Generator
from contextlib import closing
from pathlib import Path

from ...errors import InputError
from ..contacts import Configuration, DistinctStates
from ..contraction import Box
from ..proof import ProofWriter
from ..search import (
    Checkpoint,
    Part,
    SearchOrder,
    SearchState,
    Slice,
    Snapshot,
    Stopwatch,
    begin_at,
    run_slices,
)
from .checkpoint import fingerprint, restore, snapshot
from .worker import BoxWorker, Setup, SliceResult

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
        self._watch = Stopwatch()
        self.setup = setup
        self.worker = worker or BoxWorker(setup)
        self.state: SearchState[Box, Configuration] = begin_at(
            [self.worker.root], setup.order, self.worker.key
        )
        self.lps = self.abandoned = self._probes = self._landed = 0
        self.covered: list[Box] = []
        self._found = DistinctStates(_DISTINCT)
        self._workers = workers
        self._proof = ProofWriter(proof, self.worker.form, setup.task.name) if proof is not None else None
        self._checkpoint: Checkpoint | None = None
        if checkpoint is not None:
            if proof is not None:
                raise InputError(checkpoint, "", "a proof can't be combined with a checkpoint")
            key = fingerprint(self.worker)
            self._checkpoint = Checkpoint(checkpoint, "task", key, self._snapshot, self._restore)
            self._checkpoint.open(resume)

    @property
    def seconds(self) -> float:
        """Time since the start, that of earlier runs of a resumed search included."""
        return self._watch.seconds

    @property
    def seconds_here(self) -> float:
        """Time since the start, without earlier runs."""
        return self._watch.seconds_here

    @property
    def is_refuted(self) -> bool:
        """Whether every box was proved empty."""
        return not (self.state.n_open or self.state.undecided or self.state.solutions)

    def run(self) -> Generator["TaskSearch", None, None]:
        """Goes on; yields itself after each step until nothing is open."""
        slices = run_slices(
            self.state, self.setup, self.worker, self._workers, self._checkpoint,
            cut=self._cut, job=lambda one: one, take_in=self._take_in, lookahead=self._lookahead,
        )  # fmt: skip
        with closing(slices):
            for _ in slices:
                yield self
            if self._proof is not None and self.is_refuted:
                self._proof.finish()

    def _snapshot(self) -> Snapshot:
        counters = {
            "lps": self.lps,
            "abandoned": self.abandoned,
            "probes": self._probes,
            "landed": self._landed,
            "seconds": self.seconds,
        }
        return snapshot(self.state, counters, self.covered)

    def _restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        counters, self.covered = restore(saved, self.state, self.worker)
        self.lps, self.abandoned = int(counters["lps"]), int(counters["abandoned"])
        self._probes, self._landed = int(counters["probes"]), int(counters["landed"])
        self._watch.earlier_s = float(counters["seconds"])
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
