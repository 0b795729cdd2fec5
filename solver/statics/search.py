"""The search over points of regions: what is known so far, and what is handed to workers."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

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
from .log import StaticsLog
from .worker import StaticsBox, StaticsJobResult, StaticsRecord, StaticsSetup, StaticsWorker

__all__ = ["StaticsSearch"]

# As a tree grows subtrees get larger and more may be under way; no number depends on how many processes work.
_LARGEST_SUBTREE, _BOXES_PER_SIZE = 64, 16
_MOST_AHEAD, _BOXES_PER_SUBTREE_AHEAD = 16, 64

PointT = TypeVar("PointT")


class StaticsSearch(Session[StaticsBox, PointT, Subtree[StaticsBox], StaticsJobResult[PointT]]):
    """A tree over the points of all regions that shows of them what its setup asks, up to the setup's limit.

    Args:
        setup: what is searched.
        known: points that are known before.
        asked: what the setup's limit was made from. A checkpoint belongs to a search that was asked the
            same, and keeps that limit: local search, from which it comes, is not the same to the last bit
            each time.
        workers: processes to use.
        proof: file for the log.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.

    Attributes:
        setup: as given.
        worker: works on the boxes here.
        state: of branch and prune; its solutions are points that were found.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: fewer than one worker; a checkpoint that exists without `resume`, is damaged, or belongs
            to another search; a checkpoint together with a proof; a file that can't be written.
    """

    setup: StaticsSetup[PointT]
    worker: StaticsWorker[PointT]

    def __init__(
        self,
        setup: StaticsSetup[PointT],
        *,
        known: tuple[PointT, ...] = (),
        asked: str = "",
        workers: int = 1,
        proof: str | Path | None = None,
        checkpoint: str | Path | None = None,
        resume: bool = False,
        watch: Stopwatch | None = None,
    ):
        workers = check_whole_number("workers", workers, least=1)
        worker = setup.worker()
        key: Callable[[StaticsBox], float] = lambda box: setup.urgency(box.bound)  # noqa: E731
        state: SearchState[StaticsBox, PointT] = begin_at(worker.roots, setup.order, key)
        state.solutions.extend(known)
        super().__init__(setup, worker, state, workers=workers, watch=watch or Stopwatch())
        self._hand_boxes, self._hand_refuted = 0, 0
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
    def shown(self) -> float:
        """What is shown of all points."""
        left = [*self.state.open_regions, *self.state.undecided]
        return self.setup.shown([box.bound for box in left])

    @property
    def best(self) -> PointT | None:
        """The best point known."""
        return min(self.state.solutions, key=self.setup.badness, default=None)

    def write_proof(self) -> bool:
        """Writes the log of what is shown, if any is asked for and anything is; whether it did."""
        left, shown = [*self.state.open_regions, *self.state.undecided], self.shown
        if self._log is None or shown == self.setup.unknown or any(box.twist is None for box in left):
            return False
        for box in left:
            self._log.add(StaticsRecord(box, None))
        self._log.finish(shown)
        return True

    def is_endless(self) -> bool:
        """False: small boxes are not split."""
        return False

    def cut(self, box: StaticsBox, depth: int) -> Subtree[StaticsBox]:
        """The boxes below `box`, more of them the larger the tree is, with what it may ask of a hand."""
        size = max(1, min(self.state.processed // _BOXES_PER_SIZE, _LARGEST_SUBTREE))
        ahead = sum(subtree.context for subtree in self.state.ahead)
        allowed = self.setup.allowance(self._hand_boxes + ahead, self._hand_refuted, self.state.processed)
        return Subtree(box, depth, size=size, context=allowed)

    def lookahead(self) -> int:
        """How many subtrees may be under way."""
        return min(self.state.processed // _BOXES_PER_SUBTREE_AHEAD, _MOST_AHEAD)

    def job(self, subtree: Subtree[StaticsBox]) -> Subtree[StaticsBox]:
        """The subtree itself."""
        return subtree

    def take_in(self, result: StaticsJobResult[PointT]) -> SubtreeResult[StaticsBox, PointT]:
        """Adds what became of a subtree to what is known."""
        self.abandoned += result.abandoned
        self._hand_boxes += result.hand_boxes
        self._hand_refuted += result.hand_refuted
        if self._log is not None:
            for record in result.records:
                self._log.add(record)
        return result.subtree

    def snapshot(self) -> Snapshot:
        """Points that were found, the limit of boxes, and what was asked of a hand."""
        numbers = {
            "limit": self.setup.limit,
            "hand_boxes": self._hand_boxes,
            "hand_refuted": self._hand_refuted,
        }
        return Snapshot(numbers, pack("point", self.setup.point_kind, self.state.solutions))

    def restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        self.setup = replace(self.setup, limit=float(saved.numbers["limit"]))
        self._hand_boxes = int(saved.numbers["hand_boxes"])
        self._hand_refuted = int(saved.numbers["hand_refuted"])
        self.worker = self.setup.worker()
        self.state.solutions = unpack("point", self.setup.point_kind, saved.arrays)


def _fingerprint(setup: StaticsSetup[PointT], asked: str) -> str:
    what = [__version__, asked, *setup.fingerprint]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()
