"""What a statics tree does with a box of patch parameters: a function of the box and the settings alone."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..proof import BoxRecord
from ..search import Outcome, SearchOrder, Subtree, SubtreeResult, search_subtree
from .points import RegionPoints
from .power import power_net
from .problem import StaticsProblem
from .surface import extents

__all__ = [
    "TWIST_SIZE",
    "Maps",
    "StaticsBox",
    "StaticsJobResult",
    "StaticsRecord",
    "StaticsSetup",
    "StaticsWorker",
]

TWIST_SIZE = 2.0**20
"""Twists are logged in whole numbers, the largest of them this."""

# Boxes with all sides narrower than this are not split.
_SMALLEST = 1e-6
# Boxes of a hand that a new worker takes, if it asks one, so that compiled code is loaded.
_WARMING_UP = 100
# Maps of parts of regions that are kept, for boxes share most of them with their neighbours.
_MOST_KEPT = 20_000

PointT = TypeVar("PointT")


class Maps(NamedTuple):
    """Control points of all contacts of a box, as maps (n, 8, 6) of a twist; see `power`.

    Attributes:
        low: enclosure of them.
        high: likewise.
        middle: about in their middle, with the inward m of length about 1.
        owner: contact (n,) of each, in ascending order.
    """

    low: Array
    high: Array
    middle: Array
    owner: Indices


@dataclass(frozen=True, eq=False)
class StaticsBox:
    """Parts of all regions.

    Attributes:
        lower: (2 n,) parameters u, v of each contact in its chart.
        upper: (2 n,)
        root: which choice of charts, by number.
        path: 0 for each split of which it is the half below, 1 for the half above.
        bound: what is shown of the points in it: that none balances with less friction, or carries more.
        twist: (6,) whole numbers that show it; None where nothing is shown.
        along: (n, 3) whole numbers along which lengths of normals are measured, where that is needed for it.
    """

    lower: Array
    upper: Array
    root: int
    path: str = ""
    bound: float = 0.0
    twist: Array | None = None
    along: Array | None = None

    @property
    def name(self) -> str:
        """The box in a log."""
        return f"{self.root}/{self.path}"


@dataclass(frozen=True, eq=False)
class StaticsRecord:
    """A box that is done with: split at a value of a parameter, or refuted.

    Attributes:
        box: the box.
        cut: parameter and value of the split; None where it is refuted.
        unreached: the tree that shows that a hand reaches nothing in it; None where its twist refutes it.
    """

    box: StaticsBox
    cut: tuple[int, float] | None
    unreached: list[BoxRecord] | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class StaticsSetup(ABC, Generic[PointT]):
    """What decides the result of every job.

    Attributes:
        problem: the problem.
        limit: boxes of which so much is shown are done with.
        order: in which the boxes of a subtree are processed.
        traced: whether records are kept.
    """

    problem: StaticsProblem
    limit: float
    order: SearchOrder
    traced: bool = False

    @property
    def shared(self) -> tuple[object, ...]:
        """Nothing: boxes stand for themselves."""
        return ()

    def new_worker(self) -> "StaticsWorker[PointT]":
        """A worker with all compiled code loaded."""
        worker = self.worker()
        worker.work(Subtree(worker.roots[0], 0, context=_WARMING_UP))
        return worker

    def allowance(self, spent: int, refuted: int, processed: int) -> int:
        """How many boxes of a hand a subtree may take; none where no hand is asked.

        Args:
            spent: such boxes that were taken so far, or that subtrees under way may take.
            refuted: boxes of this tree that were refuted by them.
            processed: boxes of this tree that were processed.
        """
        del spent, refuted, processed
        return 0

    def give_up(self, job: Subtree[StaticsBox]) -> "StaticsJobResult[PointT]":
        """A box that no process survived is neither refuted nor split."""
        return StaticsJobResult(SubtreeResult(processed=1, undecided=[job.region], decided=1.0), abandoned=1)

    @property
    @abstractmethod
    def fingerprint(self) -> list[Any]:
        """Of all that decides the result, but for the limit: plain data."""

    @property
    @abstractmethod
    def point_kind(self) -> type[PointT]:
        """The flat dataclass of points that are found."""

    @property
    @abstractmethod
    def unknown(self) -> float:
        """The bound of a box of which nothing is shown."""

    @abstractmethod
    def worker(self) -> "StaticsWorker[PointT]":
        """A worker."""

    @abstractmethod
    def urgency(self, bound: float) -> float:
        """What best first goes by: the smallest first."""

    @abstractmethod
    def shown(self, bounds: Sequence[float]) -> float:
        """What is shown of all points where open boxes have these bounds."""

    @abstractmethod
    def badness(self, point: PointT) -> float:
        """The smaller, the better a point is."""


@dataclass
class StaticsJobResult(Generic[PointT]):
    """What became of a subtree of boxes.

    Attributes:
        subtree: what the search goes on with.
        records: of boxes that were split or refuted.
        abandoned: boxes given up because every process that worked on them died.
        hand_boxes: of the hand's kinematic search that were taken to refute boxes.
        hand_refuted: boxes that were refuted by them.
    """

    subtree: SubtreeResult[StaticsBox, PointT] = field(default_factory=SubtreeResult)
    records: list[StaticsRecord] = field(default_factory=list)
    abandoned: int = 0
    hand_boxes: int = 0
    hand_refuted: int = 0


class StaticsWorker(ABC, Generic[PointT]):
    """Refutes or splits boxes of one problem.

    Args:
        setup: what is asked.
        points: of the problem.
    """

    def __init__(self, setup: StaticsSetup[PointT], points: RegionPoints):
        self._setup, self._points = setup, points
        self._choices = setup.problem.choices
        self._kept: dict[tuple[int, int, bytes], tuple[Array, Array, Array, Array]] = {}
        self._records: list[StaticsRecord] = []
        self._allowed, self._hand_boxes, self._hand_refuted = 0, 0, 0

    @property
    def roots(self) -> list[StaticsBox]:
        """The initial boxes, which together are all points of all regions."""
        n = 2 * self._setup.problem.n_contacts
        return [
            StaticsBox(np.zeros(n), np.ones(n), root, bound=self._setup.unknown)
            for root in range(len(self._choices))
        ]

    def work(self, job: Subtree[StaticsBox]) -> StaticsJobResult[PointT]:
        """Processes the first boxes of a subtree, whose context is how many boxes of a hand it may take."""
        self._records = []
        self._allowed, self._hand_boxes, self._hand_refuted = job.context, 0, 0
        subtree = search_subtree(
            job, self._process, self._setup.order, lambda box: self._setup.urgency(box.bound)
        )
        return StaticsJobResult(
            subtree,
            self._records if self._setup.traced else [],
            hand_boxes=self._hand_boxes,
            hand_refuted=self._hand_refuted,
        )

    @abstractmethod
    def refute(self, box: StaticsBox, maps: Maps) -> tuple[StaticsBox, bool, Array]:
        """The box with what is shown of it, whether that is enough, and how much each side (2 n,) counts."""

    @abstractmethod
    def points_within(self, box: StaticsBox) -> list[PointT]:
        """A point better than what is known, where the middle of the box leads to one."""

    def out_of_reach(self, box: StaticsBox) -> list[BoxRecord] | None:
        """The tree that shows that no hand touches points of the box; None where nothing is known of any.

        It keeps count of what it takes, and to what is allowed.
        """
        return None

    def _process(self, box: StaticsBox) -> Outcome[StaticsBox, PointT]:
        box, is_done, counts = self.refute(box, self._maps(box))
        if is_done:
            self._records.append(StaticsRecord(box, None))
            return Outcome()
        unreached = self.out_of_reach(box)
        if unreached is not None:
            self._hand_refuted += 1
            self._records.append(StaticsRecord(box, None, unreached))
            return Outcome()
        found = self.points_within(box)
        if float((box.upper - box.lower).max()) <= _SMALLEST:
            return Outcome(found, undecided=box)
        k = int(np.argmax(counts * (box.upper - box.lower > _SMALLEST)))
        value = float(0.5 * (box.lower[k] + box.upper[k]))
        self._records.append(StaticsRecord(box, (k, value)))
        children = []
        for side in ("0", "1"):
            lower, upper = box.lower.copy(), box.upper.copy()
            (upper if side == "0" else lower)[k] = value
            children.append(replace(box, lower=lower, upper=upper, path=box.path + side))
        return Outcome(found, children)

    def _extents(self, box: StaticsBox) -> Array:
        """How far point and normal move along each side (2 n,)."""
        return np.concatenate([part[3] for part in self._parts(box)])

    def _maps(self, box: StaticsBox) -> Maps:
        parts = self._parts(box)
        owner = np.repeat(np.arange(len(parts), dtype=np.int64), [len(part[0]) for part in parts])
        low, high, middle = (np.concatenate([part[k] for part in parts]) for k in range(3))
        return Maps(low, high, middle, owner)

    def _parts(self, box: StaticsBox) -> list[tuple[Array, Array, Array, Array]]:
        return [
            self._part(i, chart, np.array([*box.lower[2 * i : 2 * i + 2], *box.upper[2 * i : 2 * i + 2]]))
            for i, chart in enumerate(self._choices[box.root])
        ]

    def _part(self, contact: int, number: int, ends: Array) -> tuple[Array, Array, Array, Array]:
        """Maps of one contact's control points, and how far its sides reach (2,)."""
        key = (contact, number, ends.tobytes())
        known = self._kept.get(key)
        if known is not None:
            return known
        part = ends[[0, 2, 1, 3]]
        chart = self._setup.problem.charts[contact][number]
        low, high = power_net(*chart.points, *chart.normals, chart.is_patch, part)
        middle = 0.5 * (low + high)
        middle /= max(float(np.abs(middle[:, 0, :3]).max()), 1e-300)
        sides = extents(*self._points.nets(contact, number), part)
        if len(self._kept) >= _MOST_KEPT:
            self._kept.clear()
        self._kept[key] = low, high, middle, sides
        return self._kept[key]
