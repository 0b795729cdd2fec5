"""What branch and prune does with a box of a polynomial system, given the solutions known near it."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ...base.numeric.arrays import Array
from ...base.numeric.linalg import square_inverse
from ..certify import Certifier, Ends, UniqueSolution, compile_kernels, enclosure
from ..contraction import CERTIFIED, EMPTY, OPEN, contract_native, smear
from ..interval import Interval, is_within
from ..search import Outcome, SearchOrder, Subtree, SubtreeResult, search_subtree
from .case import Choice, SystemCase, SystemCases, halved, is_chosen
from .found import CaseSolution, KnownInCases
from .parts import Parts

__all__ = ["SolutionBox", "SystemBox", "SystemJob", "SystemJobResult", "SystemSetup", "SystemWorker"]


_SLICES = 8  # by the counts of `./run bench systems`: fewer prune less, more cost more than they save
_SMALL = 0.1  # share of its place at which a box is worth a look for the one solution it may hold
_SHOWN = 6  # coordinates in the words for a box
_NARROWEST = 1e-13  # the same for boxes that floats hardly split


@dataclass(frozen=True, eq=False)
class SystemBox:
    """A box of the unknowns.

    Attributes:
        lower: (n,)
        upper: (n,)
        choice: ways for each equation to hold that are left.
        postponed: whether it waits until all others are done, for a multiple solution is in the way.
    """

    lower: Array
    upper: Array
    choice: Choice
    postponed: bool = False


@dataclass(frozen=True, eq=False, repr=False)
class SolutionBox:
    """A box of the result.

    Attributes:
        lower: (n,)
        upper: (n,)
        certified: True where a true solution is proved to lie in it (exactly one, for square systems).
    """

    lower: Array
    upper: Array
    certified: bool

    def __str__(self) -> str:
        shown = ", ".join(f"{value:.9g}" for value in self.middle[:_SHOWN])
        more = ", ..." if self.middle.size > _SHOWN else ""
        proof = "certified" if self.certified else "not certified"
        return f"({shown}{more}) within {self.radius:.1e}, {proof}"

    def __repr__(self) -> str:
        return f"<SolutionBox {self}>"

    @property
    def middle(self) -> Array:
        """Middle (n,) of the box."""
        return 0.5 * (self.lower + self.upper)

    @property
    def radius(self) -> float:
        """A number such that every point of the box is within it of the middle, in every variable."""
        middle = self.middle
        return float(np.nextafter(np.maximum(self.upper - middle, middle - self.lower).max(), np.inf))


FoundSolution = CaseSolution | SolutionBox


@dataclass(frozen=True)
class SystemJob:
    """A subtree to be searched.

    Attributes:
        subtree: the subtree.
        known: solutions whose regions meet its root.
    """

    subtree: Subtree[SystemBox]
    known: list[CaseSolution]


@dataclass
class SystemJobResult:
    """What became of a job.

    Attributes:
        subtree: what the search goes on with: solutions that are alone in a region, some of them perhaps
            known elsewhere; or small boxes of a cover.
        abandoned: boxes given up because every process that worked on them died.
    """

    subtree: SubtreeResult[SystemBox, FoundSolution] = field(default_factory=SubtreeResult)
    abandoned: int = 0


@dataclass(frozen=True, eq=False)
class SystemSetup:
    """What decides the result of every job.

    Attributes:
        equations: the ways for each of them to hold.
        ends: of the box, for each unknown.
        sigma: narrower boxes are not split.
        order: in which the boxes of a subtree are processed.
    """

    equations: tuple[Parts, ...]
    ends: Ends
    sigma: float
    order: SearchOrder

    @property
    def shared(self) -> tuple[object, ...]:
        """Nothing: boxes and solutions refer to no part of the setup."""
        return ()

    @property
    def covers(self) -> bool:
        """Whether boxes cover the solution set: there are fewer equations than unknowns."""
        return len(self.equations) < len(self.ends)

    def new_worker(self) -> "SystemWorker":
        """A worker for this process."""
        return SystemWorker(self)

    def give_up(self, job: SystemJob) -> SystemJobResult:
        """The result of a job that no process survived: the box is neither refuted nor split."""
        return SystemJobResult(
            SubtreeResult(processed=1, undecided=[job.subtree.region], decided=1.0), abandoned=1
        )


def is_postponed(box: SystemBox) -> bool:
    """Whether a box was postponed."""
    return box.postponed


class SystemWorker:
    """Does the jobs of one search.

    Attributes:
        setup: of the search.
        cases: of the system.
        key: what best first goes by, where that is the order.
    """

    def __init__(self, setup: SystemSetup):
        compile_kernels()
        self.setup = setup
        self.cases = SystemCases(setup.equations, setup.ends)
        self.key: Callable[[SystemBox], float] | None = None
        if setup.order is SearchOrder.BEST_FIRST:
            self.key = self._newton_reach
        self._m, self._n = len(setup.equations), len(setup.ends)
        self._sigma = setup.sigma
        self._known = KnownInCases(self.cases, self._n)

    @property
    def root(self) -> SystemBox:
        """The initial box."""
        return SystemBox(*enclosure(self.setup.ends), self.cases.every_way)

    @np.errstate(all="ignore")  # overflow is part of the arithmetic, which is on the safe side of it
    def work(self, job: SystemJob) -> SystemJobResult:
        """Processes the first boxes of a subtree."""
        self._known = KnownInCases(self.cases, self._n, job.known)
        return SystemJobResult(
            search_subtree(job.subtree, self._process, self.setup.order, self.key, is_postponed)
        )

    def _process(self, box: SystemBox) -> Outcome[SystemBox, FoundSolution]:
        """Contracts a box; certifies, splits, or postpones it where a multiple solution is in the way."""
        if self._m == 0:
            return Outcome([SolutionBox(box.lower, box.upper, certified=True)])
        case = self.cases.of(box.choice)
        if case.is_refuted:
            return Outcome()
        lower, upper = np.maximum(box.lower, case.box[0]), np.minimum(box.upper, case.box[1])
        if np.any(lower > upper):
            return Outcome()
        if case.is_root:
            root = UniqueSolution((lower, upper), (lower, upper), inside=True)
            return Outcome([CaseSolution(box.choice, root)])
        chosen = is_chosen(box.choice)
        if chosen and self._known.of(box.choice).solves((lower, upper)):
            return Outcome()
        status = _contract(case.certifier, lower, upper)
        if status == EMPTY:
            return Outcome()
        left = SystemBox(lower, upper, box.choice, box.postponed)
        if not chosen:
            return Outcome(children=[replace(left, choice=half) for half in halved(box.choice)])
        if self._known.of(box.choice).solves((lower, upper)):
            return Outcome()
        if self.setup.covers:
            return self._cover(case, left)
        if status == CERTIFIED:
            return self._account_for(case, left, (lower, upper))
        return self._look_around(case, left) or self._halve(case, left)

    def _look_around(self, case: SystemCase, box: SystemBox) -> Outcome[SystemBox, FoundSolution] | None:
        """What follows from a solution in or next to a small box, if there seems to be one."""
        near = self._solution_near(case.certifier, box)
        if near is None:
            return None
        if self._m == self._n and not self._known.of(box.choice).solves((near, near)):
            around = case.certifier.widest_unique(near, case.asked.scale(near))
            if around is not None and is_within((box.lower, box.upper), around):
                return self._account_for(case, box, around)
        if not box.postponed and not self._is_narrow(box) and self._is_singular(case.certifier, near):
            return Outcome(postponed=replace(box, postponed=True))
        return None

    def _halve(self, case: SystemCase, box: SystemBox) -> Outcome[SystemBox, FoundSolution]:
        return Outcome(undecided=box) if self._is_narrow(box) else Outcome(children=self._split(case, box))

    def _is_narrow(self, box: SystemBox) -> bool:
        least = _NARROWEST * np.maximum(np.abs(box.lower), np.abs(box.upper))
        return bool(np.all(box.upper - box.lower <= np.maximum(self._sigma, least)))

    def _solution_near(self, certifier: Certifier, box: SystemBox) -> Array | None:
        """An approximate solution in or next to a small box (a guess, no proof)."""
        lower, upper = box.lower, box.upper
        if np.any(upper - lower > _SMALL * (1.0 + np.abs(upper))):
            return None
        room = np.maximum(upper - lower, 1e-9 * (1.0 + np.abs(upper)))
        return certifier.approximate(0.5 * (lower + upper), (lower - room, upper + room))

    def _is_singular(self, certifier: Certifier, x: Array) -> bool:
        """Whether the Jacobian seems to lose rank (a guess, no proof)."""
        J = certifier.middle_slopes(x)[1]
        if not np.isfinite(J).all():
            return False
        values = np.linalg.svd(J, compute_uv=False)
        return bool(values[-1] <= 1e-6 * values[0])

    def _cover(self, case: SystemCase, box: SystemBox) -> Outcome[SystemBox, FoundSolution]:
        """Fewer equations than unknowns: small boxes make up the result."""
        if not self._is_narrow(box):
            return Outcome(children=self._split(case, box))
        certified = self._holds_point(case, box.lower, box.upper)
        return Outcome([SolutionBox(box.lower, box.upper, certified)])

    def _holds_point(self, case: SystemCase, lower: Array, upper: Array) -> bool:
        """Whether a solution is proved in the box: with all but m variables held at a point's values."""
        x = case.certifier.approximate(0.5 * (lower + upper))
        if x is None:
            return False
        x = np.clip(x, lower, upper)
        k = self._m
        rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
        J = case.certifier.middle_slopes(x)[1]
        if not square_inverse(J, upper - lower, rows, columns, np.empty((k, k))):
            return False
        low, high = x.copy(), x.copy()
        room = 1e-10 * (1.0 + np.abs(x[columns]))
        low[columns] = np.maximum(lower[columns], x[columns] - room)
        high[columns] = np.minimum(upper[columns], x[columns] + room)
        # The root is rounded outward, so a point on its rim may lie outside of what was asked for.
        return case.certifier.test(x, (low, high))[0] and case.asked.holds((low, high))

    def _account_for(
        self, case: SystemCase, box: SystemBox, region: Interval
    ) -> Outcome[SystemBox, FoundSolution]:
        """Accounts for the only solution of a region; what else was in the box at hand is done with."""
        certifier, known = case.certifier, self._known.of(box.choice)
        place = certifier.refine(region, case.asked.scale(0.5 * (region[0] + region[1])))
        same = known.holds(place, region)
        if same:
            return Outcome()
        if same is None:  # it can't be told from a solution that is known
            return Outcome(undecided=SystemBox(*case.asked.clip(place), box.choice))
        middle = 0.5 * (place[0] + place[1])
        wide = certifier.widest_unique(middle, case.asked.scale(middle))
        # The solution of `wide` is that of `region` if it is bound to lie in both.
        if wide is None or not (is_within(place, wide) or is_within(wide, region)):
            wide = region
        inside, place = case.asked.decide(place, region)
        found = CaseSolution(box.choice, UniqueSolution(wide, place, inside))
        self._known.add(found)
        return Outcome([found])

    def _split(self, case: SystemCase, box: SystemBox) -> tuple[SystemBox, SystemBox]:
        """Two halves, cut across the variable that blurs the equations most."""
        lower, upper = box.lower, box.upper
        width = upper - lower
        if self.setup.covers:
            score = width
        else:
            score = smear(case.certifier.system, lower, upper, case.certifier.workspace)
        size = np.maximum(np.abs(lower), np.abs(upper))
        splits = width > np.maximum(_NARROWEST * size, min(self._sigma, 1e-9))
        score = np.where(splits, np.nan_to_num(score, nan=np.inf, posinf=np.inf), -1.0)
        k = int(np.argmax(score))
        at = lower[k] + 0.4871 * width[k]  # off the middle: solutions like to sit on symmetric places
        left, right = upper.copy(), lower.copy()
        left[k] = right[k] = at
        return replace(box, upper=left), replace(box, lower=right)

    @np.errstate(all="ignore")
    def _newton_reach(self, box: SystemBox) -> float:
        """How far Newton's method steps from the middle, in widths of the box; within 0.5 it stays inside."""
        x, width = 0.5 * (box.lower + box.upper), box.upper - box.lower
        f, J = self.cases.of(box.choice).certifier.middle_slopes(x)
        if not len(f) or not (np.isfinite(f).all() and np.isfinite(J * width).all()):
            return np.inf
        try:
            step = np.linalg.lstsq(J * width, -f, rcond=1e-10)[0]
        except np.linalg.LinAlgError:
            return np.inf
        reach = float(np.abs(step).max(initial=0.0))
        return reach if reach < np.inf else np.inf


def _contract(certifier: Certifier, lower: Array, upper: Array) -> int:
    """`contract_native` with the equations at hand; there may be none yet."""
    if not certifier.m:
        return OPEN
    return contract_native(certifier.system, certifier.program, lower, upper, certifier.workspace, _SLICES)
