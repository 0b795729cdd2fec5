"""The search for configurations of a task: what is known so far, and what is handed to workers."""

from dataclasses import replace
from pathlib import Path

from ...arguments import check_whole_number
from ...errors import InputError
from ..contacts import Configuration, DistinctStates
from ..contraction import Box
from ..proof import ProofWriter
from ..search import (
    SearchOrder,
    SearchState,
    Session,
    Snapshot,
    Stopwatch,
    Subtree,
    SubtreeResult,
    begin_at,
    is_part,
)
from .checkpoint import fingerprint, restore, snapshot
from .worker import TaskJobResult, TaskSetup, TaskWorker

__all__ = ["TaskSearch"]

# Configurations nearer to each other than this (see `distance`) count as one.
_DISTINCT = 0.1
# Inputs that get bounds from linear programs, the widest first: by the measurements of docs/solver.md.
_TIGHTENED = 5
# Fewer where Newton's method starts from each program's point: more boxes help it sooner than narrower ones.
_TIGHTENED_PURELY = 2
# Linear programs come in where less than this share of the local searches lands.
_LANDING_SHARE = 0.125
# A young tree is searched box by box. As it grows subtrees get larger, the sooner the cheaper a box is, so
# that handing them to another process is worth while; and more of them may be under way, fewer of them where
# depth comes first. No number here depends on how many processes there are.
_LARGEST_SUBTREE, _BOXES_PER_SIZE = 16, 16
_LARGEST_LP_SUBTREE, _BOXES_PER_LP_SIZE = 4, 64
_MOST_AHEAD, _BOXES_PER_SUBTREE_AHEAD, _BOXES_PER_SUBTREE_AHEAD_DEPTH_FIRST = 64, 4, 16


class TaskSearch(Session[Box, Configuration, Subtree[Box], TaskJobResult]):
    """A search for configurations of a task, which can be looked at between its steps.

    Args:
        setup: what is searched.
        workers: processes to use.
        proof: file for the proof log.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.
        worker: works on the boxes here; made from `setup` unless given.

    Attributes:
        setup: as given.
        worker: works on the boxes here.
        state: of branch and prune.
        lps: linear programs solved.
        covered: where the solution set is to be covered, small boxes with a certified configuration inside.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: fewer than one worker; a checkpoint that exists without `resume`, is damaged, or belongs
            to another search; a checkpoint together with a proof; a file that can't be written.
    """

    setup: TaskSetup
    worker: TaskWorker

    def __init__(
        self,
        setup: TaskSetup,
        *,
        workers: int = 1,
        proof: str | Path | None = None,
        checkpoint: str | Path | None = None,
        resume: bool = False,
        worker: TaskWorker | None = None,
    ):
        workers = check_whole_number("workers", workers, least=1)
        watch = Stopwatch()
        worker = worker or TaskWorker(setup)
        state: SearchState[Box, Configuration] = begin_at([worker.root], setup.order, worker.key)
        super().__init__(setup, worker, state, workers=workers, watch=watch, at_end=self._finish_proof)
        self.lps = self._probes = self._landed = 0
        self.covered: list[Box] = []
        self._distinct = DistinctStates(_DISTINCT)
        self._proof = ProofWriter(proof, worker.form, setup.task.name) if proof is not None else None
        if checkpoint is not None:
            if proof is not None:
                raise InputError(checkpoint, "", "a proof can't be combined with a checkpoint")
            self.keep_in(
                checkpoint,
                what="task",
                fingerprint=fingerprint(worker),
                kind=Box,
                is_part=is_part,
                resume=resume,
            )

    @property
    def is_refuted(self) -> bool:
        """Whether every box was proved empty."""
        return not (self.state.n_open or self.state.undecided or self.state.solutions)

    def is_endless(self) -> bool:
        """False: boxes below sigma are not split."""
        return False

    def cut(self, box: Box, depth: int) -> Subtree[Box]:
        """The boxes below `box`, more of them the larger the tree is."""
        tightened, boxes = self._tightened(), self.state.processed
        size = min(boxes // _BOXES_PER_SIZE, _LARGEST_SUBTREE)
        if tightened:
            size = min(boxes // _BOXES_PER_LP_SIZE, _LARGEST_LP_SUBTREE)
        return Subtree(box, depth, size=max(size, 1), context=tightened)

    def lookahead(self) -> int:
        """How many subtrees may be under way: one on the way down to a known solution, which is short."""
        ahead = [subtree.region for subtree in self.state.ahead]
        ahead += [entry[3] for entry in self.state.frontier[:1]]
        if any(box.witness is not None for box in ahead):
            return 1
        depth_first = self.setup.order is SearchOrder.DEPTH_FIRST
        boxes = _BOXES_PER_SUBTREE_AHEAD_DEPTH_FIRST if depth_first else _BOXES_PER_SUBTREE_AHEAD
        return min(self.state.processed // boxes, _MOST_AHEAD)

    def job(self, subtree: Subtree[Box]) -> Subtree[Box]:
        """The subtree itself, whose context is the number of inputs to tighten."""
        return subtree

    def take_in(self, result: TaskJobResult) -> SubtreeResult[Box, Configuration]:
        """Adds what became of a subtree to what is known; configurations near known ones are left out."""
        self.lps += result.lps
        self._probes += result.probes
        self._landed += result.landed
        self.abandoned += result.abandoned
        if self._proof is not None:
            for record in result.records:
                self._proof.add(record)
        self.covered += result.covered
        if self.setup.cover:
            return result.subtree
        distinct = [c for c in result.subtree.solutions if self._distinct.add(c.state)]
        return replace(result.subtree, solutions=distinct)

    def snapshot(self) -> Snapshot:
        """Configurations, boxes of the cover, counts."""
        counters = {"lps": self.lps, "probes": self._probes, "landed": self._landed}
        return snapshot(self.state.solutions, self.covered, counters)

    def restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        self.state.solutions, self.covered = restore(saved, self.worker)
        self.lps = int(saved.numbers["lps"])
        self._probes, self._landed = int(saved.numbers["probes"]), int(saved.numbers["landed"])
        for configuration in self.state.solutions:
            self._distinct.add(configuration.state)

    def _finish_proof(self) -> None:
        if self._proof is not None and self.is_refuted:
            self._proof.finish()

    def _tightened(self) -> int:
        """How many inputs to tighten by linear programs in the next subtree.

        While enough local searches land, the tree serves only to spread the starts, and propagation at
        a hundredth of the cost does that as well.
        """
        if self.setup.cover or (not self.setup.pure and self._landed >= _LANDING_SHARE * self._probes):
            return 0
        return _TIGHTENED_PURELY if self.setup.pure else _TIGHTENED
