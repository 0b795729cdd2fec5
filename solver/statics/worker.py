"""What the statics tree does with a box of patch parameters: a function of the box and the settings alone."""

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array, Indices
from ..search import Outcome, SearchOrder, Subtree, SubtreeResult, search_subtree
from .climb import BalancedPoint, Climber
from .power import power_net, refuted_friction
from .problem import StaticsProblem
from .separation import SEPARATED, separate
from .surface import extents

__all__ = ["StaticsBox", "StaticsJobResult", "StaticsRecord", "StaticsSetup", "StaticsWorker"]

# Twists are logged in whole numbers, the largest of them this.
_TWIST_SIZE = 2.0**20
# Boxes with all sides narrower than this are not split.
_SMALLEST = 1e-6
# Share of a contact's weight in the nearest point that counts for splitting it though it has none.
_LEAST_WEIGHT = 0.1
# Maps of parts of regions that are kept, for boxes share most of them with their neighbours.
_MOST_KEPT = 20_000


@dataclass(frozen=True, eq=False)
class StaticsBox:
    """Parts of all regions.

    Attributes:
        lower: (2 n,) parameters u, v of each contact in its chart.
        upper: (2 n,)
        root: which choice of charts, by number.
        path: 0 for each split of which it is the half below, 1 for the half above.
        bound: no friction below this balances points in it.
        twist: (6,) whole numbers, along which all forces have positive power up to that friction, but for
            where `bound` is zero.
    """

    lower: Array
    upper: Array
    root: int
    path: str = ""
    bound: float = 0.0
    twist: Array | None = None

    @property
    def name(self) -> str:
        """The box in a log."""
        return f"{self.root}/{self.path}"


@dataclass(frozen=True, eq=False)
class StaticsRecord:
    """A box that is done with: split at a value of a parameter, or refuted by its twist.

    Attributes:
        box: the box.
        cut: parameter and value of the split; None where it is refuted.
    """

    box: StaticsBox
    cut: tuple[int, float] | None


@dataclass(frozen=True, eq=False)
class StaticsSetup:
    """What decides the result of every job.

    Attributes:
        problem: the problem.
        friction: boxes are refuted at this coefficient, and not looked at beyond.
        steps: where that fails, bisections for a lower one at which a box is refuted.
        order: in which the boxes of a subtree are processed.
        traced: whether records are kept.
    """

    problem: StaticsProblem
    friction: float
    steps: int
    order: SearchOrder
    traced: bool = False

    @property
    def shared(self) -> tuple[object, ...]:
        """Nothing: boxes stand for themselves."""
        return ()

    def new_worker(self) -> "StaticsWorker":
        """A worker with all compiled code loaded."""
        worker = StaticsWorker(self)
        worker.work(Subtree(worker.roots[0], 0))
        return worker

    def give_up(self, job: Subtree[StaticsBox]) -> "StaticsJobResult":
        """A box that no process survived is neither refuted nor split."""
        return StaticsJobResult(SubtreeResult(processed=1, undecided=[job.region], decided=1.0), abandoned=1)


@dataclass
class StaticsJobResult:
    """What became of a subtree of boxes.

    Attributes:
        subtree: what the search goes on with.
        records: of boxes that were split or refuted.
        abandoned: boxes given up because every process that worked on them died.
    """

    subtree: SubtreeResult[StaticsBox, BalancedPoint] = field(default_factory=SubtreeResult)
    records: list[StaticsRecord] = field(default_factory=list)
    abandoned: int = 0


class StaticsWorker:
    """Refutes or splits boxes of one problem."""

    def __init__(self, setup: StaticsSetup):
        self.setup = setup
        self.climber = Climber(setup.problem)
        self._choices = setup.problem.choices
        self._kept: dict[tuple[int, int, bytes], tuple[Array, Array, Array, Array]] = {}
        self._records: list[StaticsRecord] = []

    @property
    def roots(self) -> list[StaticsBox]:
        """The initial boxes, which together are all points of all regions."""
        n = 2 * self.setup.problem.n_contacts
        return [StaticsBox(np.zeros(n), np.ones(n), root) for root in range(len(self._choices))]

    def work(self, job: Subtree[StaticsBox]) -> StaticsJobResult:
        """Processes the first boxes of a subtree."""
        self._records = []
        subtree = search_subtree(job, self._process, self.setup.order, lambda box: box.bound)
        return StaticsJobResult(subtree, self._records if self.setup.traced else [])

    def _process(self, box: StaticsBox) -> Outcome[StaticsBox, BalancedPoint]:
        low, high, middle, owner = self._maps(box)
        problem, n = self.setup.problem, self.setup.problem.n_contacts
        arms, reaches = problem.arms[owner], problem.reaches[owner]
        bound, twist, goal = box.bound, box.twist, self.setup.friction
        if twist is not None:
            bound = max(bound, refuted_friction(low, high, arms, reaches, twist))

        def refute(friction: float) -> Array:
            """Raises the bound by a twist for this friction, if any; how much contacts count (n,)."""
            nonlocal bound, twist
            status, y, wrenches = separate(middle, arms, reaches, owner, friction, n)
            if status == SEPARATED:
                whole = np.rint(y / np.abs(y).max() * _TWIST_SIZE)
                proved = refuted_friction(low, high, arms, reaches, whole)
                if proved > bound:
                    bound, twist = proved, whole
            return np.asarray(np.linalg.norm(wrenches[:, :3], axis=1))

        weights = refute(goal) if bound <= goal else np.zeros(n)
        above = goal
        for _ in range(self.setup.steps if bound <= goal else 0):
            friction = 0.5 * (bound + above)
            before = bound
            weights = refute(friction)
            above = friction if bound == before else max(above, bound)
        if bound > goal:
            self._records.append(StaticsRecord(self._with(box, bound, twist), None))
            return Outcome()
        found = self._point_within(box)
        if float((box.upper - box.lower).max()) <= _SMALLEST:
            return Outcome(found, undecided=self._with(box, bound, twist))
        k, value = self._cut(box, weights)
        self._records.append(StaticsRecord(box, (k, value)))
        children = []
        for side in ("0", "1"):
            lower, upper = box.lower.copy(), box.upper.copy()
            (upper if side == "0" else lower)[k] = value
            children.append(StaticsBox(lower, upper, box.root, box.path + side, bound, twist))
        return Outcome(found, children)

    @staticmethod
    def _with(box: StaticsBox, bound: float, twist: Array | None) -> StaticsBox:
        return StaticsBox(box.lower, box.upper, box.root, box.path, bound, twist)

    def _point_within(self, box: StaticsBox) -> list[BalancedPoint]:
        """A point that needs no more friction than the goal, where the middle of the box leads to one."""
        middle = 0.5 * (box.lower + box.upper)
        if self.climber.needed_at(box.root, middle) > self.setup.friction:
            return []
        return [self.climber.climb(box.root, middle)]

    def _cut(self, box: StaticsBox, weights: Array) -> tuple[int, float]:
        """The parameter and value to split at: the widest side, by what its contact counts for."""
        widths = np.concatenate([part[3] for part in self._parts(box)])
        counts = np.repeat(weights / max(weights.max(), 1e-12) + _LEAST_WEIGHT, 2)
        k = int(np.argmax(widths * counts * (box.upper - box.lower > _SMALLEST)))
        return k, float(0.5 * (box.lower[k] + box.upper[k]))

    def _maps(self, box: StaticsBox) -> tuple[Array, Array, Array, Indices]:
        """Maps of all control points: below, above, in the middle with m about 1; and whose they are."""
        parts = self._parts(box)
        owner = np.repeat(np.arange(len(parts), dtype=np.int64), [len(part[0]) for part in parts])
        low, high, middle = (np.concatenate([part[k] for part in parts]) for k in range(3))
        return low, high, middle, owner

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
        chart = self.setup.problem.charts[contact][number]
        low, high = power_net(*chart.points, *chart.normals, chart.is_patch, part)
        middle = 0.5 * (low + high)
        middle /= max(float(np.abs(middle[:, 0, :3]).max()), 1e-300)
        sides = extents(*self.climber.nets(contact, number), part)
        if len(self._kept) >= _MOST_KEPT:
            self._kept.clear()
        self._kept[key] = low, high, middle, sides
        return self._kept[key]
