"""The search over points of regions: what is known so far, and what is handed to workers."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ... import __version__
from ...arguments import check_whole_number
from ...errors import InputError
from ..search import (
    SearchState,
    Session,
    Snapshot,
    Stopwatch,
    Subtree,
    SubtreeResult,
    begin_at,
    is_part,
    pack,
    unpack,
)
from .climb import BalancedPoint
from .log import StaticsLog
from .worker import StaticsBox, StaticsJobResult, StaticsRecord, StaticsSetup, StaticsWorker

__all__ = ["StaticsSearch"]

# As a tree grows subtrees get larger and more may be under way; no number depends on how many processes work.
_LARGEST_SUBTREE, _BOXES_PER_SIZE = 64, 16
_MOST_AHEAD, _BOXES_PER_SUBTREE_AHEAD = 16, 64


class StaticsSearch(Session[StaticsBox, BalancedPoint, Subtree[StaticsBox], StaticsJobResult]):
    """A tree over the points of all regions that refutes balance up to the friction of its setup.

    Args:
        setup: what is searched. With best first as its order, boxes of which less is refuted come first.
        known: points that balance, which are known before.
        asked: what the setup's friction was made from. A checkpoint belongs to a search that was asked the
            same, and keeps that friction: local search, from which it comes, is not the same to the last bit
            each time.
        workers: processes to use.
        proof: file for the log.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.

    Attributes:
        setup: as given.
        worker: works on the boxes here.
        state: of branch and prune; its solutions are points that need no more than the setup's friction.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: fewer than one worker; a checkpoint that exists without `resume`, is damaged, or belongs
            to another search; a checkpoint together with a proof; a file that can't be written.
    """

    setup: StaticsSetup
    worker: StaticsWorker

    def __init__(
        self,
        setup: StaticsSetup,
        *,
        known: tuple[BalancedPoint, ...] = (),
        asked: str = "",
        workers: int = 1,
        proof: str | Path | None = None,
        checkpoint: str | Path | None = None,
        resume: bool = False,
        watch: Stopwatch | None = None,
    ):
        workers = check_whole_number("workers", workers, least=1)
        worker = StaticsWorker(setup)
        key: Callable[[StaticsBox], float] = lambda box: box.bound  # noqa: E731
        state: SearchState[StaticsBox, BalancedPoint] = begin_at(worker.roots, setup.order, key)
        state.solutions.extend(known)
        super().__init__(setup, worker, state, workers=workers, watch=watch or Stopwatch())
        self._log = StaticsLog(proof, setup.problem) if proof is not None else None
        if checkpoint is not None:
            if proof is not None:
                raise InputError(checkpoint, "", "a proof can't be combined with a checkpoint")
            self.keep_in(
                checkpoint,
                what="task",
                fingerprint=_fingerprint(setup, asked),
                kind=StaticsBox,
                is_part=is_part,
                resume=resume,
            )

    @property
    def refuted(self) -> float:
        """No points of these regions balance with this friction or less: proved; 0 where nothing is."""
        left = [*self.state.open_regions, *self.state.undecided]
        # A box's bound is refuted below it.
        bound = min([box.bound for box in left], default=np.inf)
        return float(min(max(0.0, np.nextafter(bound, -np.inf)), self.setup.friction))

    @property
    def least(self) -> BalancedPoint | None:
        """The point known to need the least friction."""
        return min(self.state.solutions, key=lambda point: point.friction, default=None)

    def write_proof(self) -> bool:
        """Writes the log of what is refuted, if any is asked for and anything is; whether it did."""
        friction = self.refuted
        if self._log is None or friction <= 0.0:
            return False
        for box in (*self.state.open_regions, *self.state.undecided):
            self._log.add(StaticsRecord(box, None))
        self._log.finish(friction)
        return True

    def is_endless(self) -> bool:
        """False: small boxes are not split."""
        return False

    def cut(self, box: StaticsBox, depth: int) -> Subtree[StaticsBox]:
        """The boxes below `box`, more of them the larger the tree is."""
        return Subtree(
            box, depth, size=max(1, min(self.state.processed // _BOXES_PER_SIZE, _LARGEST_SUBTREE))
        )

    def lookahead(self) -> int:
        """How many subtrees may be under way."""
        return min(self.state.processed // _BOXES_PER_SUBTREE_AHEAD, _MOST_AHEAD)

    def job(self, subtree: Subtree[StaticsBox]) -> Subtree[StaticsBox]:
        """The subtree itself."""
        return subtree

    def take_in(self, result: StaticsJobResult) -> SubtreeResult[StaticsBox, BalancedPoint]:
        """Adds what became of a subtree to what is known."""
        self.abandoned += result.abandoned
        if self._log is not None:
            for record in result.records:
                self._log.add(record)
        return result.subtree

    def snapshot(self) -> Snapshot:
        """Points that balance, and the friction that boxes are refuted at."""
        return Snapshot({"friction": self.setup.friction}, pack("point", BalancedPoint, self.state.solutions))

    def restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        self.setup = replace(self.setup, friction=float(saved.numbers["friction"]))
        self.worker = StaticsWorker(self.setup)
        self.state.solutions = unpack("point", BalancedPoint, saved.arrays)


def _fingerprint(setup: StaticsSetup, asked: str) -> str:
    what = [__version__, setup.problem.form, asked, setup.steps, setup.order.value]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()
