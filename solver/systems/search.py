"""The search for all solutions of a polynomial system: what is known, and what is handed to workers."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from ...arguments import check_instance, check_number, check_whole_number
from ...base.numeric.arrays import Array, Mask
from ...errors import InputError
from ..certify import Ends, compile_kernels, enclosure
from ..interval import Interval
from ..polynomial import ExactPolynomial, FactoredPolynomial
from ..search import (
    Progress,
    SearchOrder,
    SearchState,
    Session,
    Snapshot,
    Stopwatch,
    Subtree,
    SubtreeResult,
    begin_at,
    check_order,
    is_part,
)
from .case import is_chosen
from .checkpoint import fingerprint, restore, snapshot
from .found import CaseSolution, KnownInCases, is_same_point
from .parts import equation_parts
from .worker import (
    SolutionBox,
    SystemBox,
    SystemJob,
    SystemJobResult,
    SystemSetup,
    SystemWorker,
    is_postponed,
)

__all__ = ["SystemSearch"]


# Boxes that were postponed are split on as long as they do not multiply beyond this: isolated multiple
# solutions shrink to a few boxes each, whereas a curve of solutions would go on without end.
_MOST_POSTPONED = 400
_DEFAULT_SIGMA = 1e-7
_DEFAULT_COVER_SIGMA = 0.05
# A young tree is searched box by box. As it grows, subtrees get larger and more of them may be under way, so
# that handing them to another process is worth while. No number here depends on how many processes there are.
_LARGEST_SUBTREE, _BOXES_PER_SIZE = 8, 32
_MOST_AHEAD, _BOXES_PER_SUBTREE_AHEAD = 32, 16


class SystemSearch(Session[SystemBox, SolutionBox, SystemJob, SystemJobResult]):
    """A search for all solutions in a closed box, which can be looked at between its steps.

    Unknowns whose interval is a point are replaced by their value, exactly, and don't count as unknowns.

    Args:
        equations: polynomials, or products of them, that must be zero.
        lower: (n,) finite lower ends, each taken exactly.
        upper: (n,) finite upper ends.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        order: which box comes next.
        workers: processes to use.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.

    Attributes:
        setup: what is searched, in the unknowns that are left.
        worker: works on the boxes here.
        state: of branch and prune; its solutions are the boxes of the result, in the unknowns that are left.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: an argument that can't be used, such as a box whose ends are not finite, not as many, or
            crossed, or an equation with an unknown that the box lacks; a checkpoint that exists
            without `resume`, is damaged, belongs to another search, or can't be written.
    """

    setup: SystemSetup
    worker: SystemWorker

    def __init__(
        self,
        equations: Sequence[ExactPolynomial | FactoredPolynomial],
        lower: Array | Sequence[Fraction],
        upper: Array | Sequence[Fraction],
        *,
        sigma: float | None = None,
        order: SearchOrder = SearchOrder.DEPTH_FIRST,
        workers: int = 1,
        checkpoint: str | Path | None = None,
        resume: bool = False,
    ):
        order, workers = check_order(order), check_whole_number("workers", workers, least=1)
        if sigma is not None:
            sigma = check_number("sigma", sigma, above=0.0)
        compile_kernels()
        watch = Stopwatch()  # compiling is not part of anybody's budget
        self._ends = _exact_ends(lower, upper)
        products = _products(equations, len(self._ends))
        self._fixed = {k: low for k, (low, high) in enumerate(self._ends) if low == high}
        setup = _setup(products, self._ends, self._fixed, sigma, order)
        worker = SystemWorker(setup)
        state: SearchState[SystemBox, SolutionBox] = begin_at([worker.root], order, worker.key, is_postponed)
        super().__init__(setup, worker, state, workers=workers, watch=watch)
        self._known = KnownInCases(worker.cases, len(setup.ends))
        self._listed = _SolutionBoxes(len(setup.ends))
        if checkpoint is not None:
            key = fingerprint(products, self._ends, setup)
            self.keep_in(
                checkpoint, what="system", fingerprint=key, kind=SystemBox, is_part=_is_part, resume=resume
            )

    @property
    def solutions(self) -> tuple[SolutionBox, ...]:
        """The boxes of the result so far, in all unknowns."""
        return tuple(
            SolutionBox(*self._whole((s.lower, s.upper)), s.certified)
            for s, doubtful in zip(self.state.solutions, self._doubtful(), strict=True)
            if not doubtful
        )

    @property
    def remaining(self) -> tuple[Interval, ...]:
        """Boxes that may hold further solutions, those that are still open among them, in all unknowns."""
        left = [(box.lower, box.upper) for box in self._left]
        left += [
            (s.lower, s.upper)
            for s, doubtful in zip(self.state.solutions, self._doubtful(), strict=True)
            if doubtful
        ]
        return tuple(self._whole(box) for box in left)

    @property
    def progress(self) -> Progress:
        """Where the search stands."""
        doubtful = sum(self._doubtful())
        now = super().progress
        return replace(now, found=now.found - doubtful, undecided=now.undecided + doubtful)

    @property
    def _left(self) -> list[SystemBox]:
        return self.state.undecided + self.state.open_regions

    def _doubtful(self) -> list[bool]:
        """Of each solution, whether it is alone in its case only: a box of another case reaches it."""
        count = len(self.state.solutions)
        left = self._left
        if self.setup.covers or is_chosen(self.worker.cases.every_way) or not left or not count:
            return [False] * count
        lower, upper = np.array([box.lower for box in left]), np.array([box.upper for box in left])
        choices = np.array([box.choice for box in left])
        return [
            bool(np.any(_meets(box, lower, upper) & np.any(choices != found.choice, axis=(1, 2))))
            for box, found in zip(self.state.solutions, self._listed.found, strict=True)
        ]

    def is_endless(self) -> bool:
        """Whether boxes that were postponed are all that is left, and too many."""
        state = self.state
        if not state.only_postponed or not all(subtree.region.postponed for subtree in state.ahead):
            return False
        return state.n_open + sum(box.postponed for box in state.undecided) > _MOST_POSTPONED

    def cut(self, box: SystemBox, depth: int) -> Subtree[SystemBox]:
        """The boxes below `box`, more of them the larger the tree is."""
        size = min(self.state.processed // _BOXES_PER_SIZE, _LARGEST_SUBTREE)
        # A box that was postponed is split no further than is decided here, for it may go on without end.
        return Subtree(box, depth, size=1 if box.postponed else max(size, 1), context=len(self._known))

    def lookahead(self) -> int:
        """How many subtrees may be under way."""
        return min(self.state.processed // _BOXES_PER_SUBTREE_AHEAD, _MOST_AHEAD)

    def job(self, subtree: Subtree[SystemBox]) -> SystemJob:
        """The subtree with what was known near it when it was cut: of that many solutions."""
        box = (subtree.region.lower, subtree.region.upper)
        return SystemJob(subtree, self._known.first_near(subtree.context, box, subtree.region.choice))

    @np.errstate(all="ignore")
    def take_in(self, result: SystemJobResult) -> SubtreeResult[SystemBox, SolutionBox]:
        """Adds what became of a subtree to what is known; solutions that are known already are left out."""
        self.abandoned += result.abandoned
        solutions: list[SolutionBox] = []
        undecided: list[SystemBox] = []
        for found in result.subtree.solutions:
            if isinstance(found, SolutionBox):
                solutions.append(found)
            else:
                self._account_for(found, solutions, undecided)
        subtree = result.subtree
        return SubtreeResult(
            processed=subtree.processed,
            solutions=solutions,
            undecided=undecided + subtree.undecided,
            decided=subtree.decided,
            open=subtree.open,
        )

    def _account_for(
        self, found: CaseSolution, solutions: list[SolutionBox], undecided: list[SystemBox]
    ) -> None:
        """Puts a solution where it belongs, unless it is known."""
        case, one = self.worker.cases.of(found.choice), found.solution
        same = self._known.of(found.choice).holds(one.place, one.region)
        if same:
            return
        clipped = case.asked.clip(one.place)
        if same is not None:
            self._known.add(found)
            box = SolutionBox(*clipped, certified=True)
            if one.inside is False:
                return
            near = self._listed.near(box)
            if one.inside and not near:
                self._listed.append(found, box)
                solutions.append(box)
                return
            if one.inside and any(is_same_point(self.worker.cases, found, other) for other in near):
                return
        undecided.append(SystemBox(*clipped, found.choice))

    def _whole(self, box: Interval) -> Interval:
        """A box with the unknowns whose interval is a point put back."""
        if not self._fixed:
            return box
        lower, upper = enclosure(self._ends)
        free = np.array([k not in self._fixed for k in range(len(self._ends))], dtype=bool)
        lower[free], upper[free] = box
        return lower, upper

    def snapshot(self) -> Snapshot:
        """Boxes of the result and known solutions."""
        return snapshot(self.state.solutions, self._known)

    def restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        self.state.solutions, known = restore(saved)
        listed = {box.lower.tobytes() + box.upper.tobytes(): box for box in self.state.solutions}
        for found in known:
            self._known.add(found)
            lower, upper = self.worker.cases.of(found.choice).asked.clip(found.solution.place)
            box = listed.pop(lower.tobytes() + upper.tobytes(), None)
            if box is not None:
                self._listed.append(found, box)


def _meets(box: SolutionBox, lower: Array, upper: Array) -> Mask:
    """Whether boxes (k, n) reach within the radius of another one: (k,)."""
    low, high = box.middle - box.radius, box.middle + box.radius
    return np.asarray(np.all((lower <= high) & (upper >= low), axis=1))


class _SolutionBoxes:
    """The solution boxes of the result, stacked.

    Attributes:
        found: the solution of each.
    """

    def __init__(self, n: int):
        self.found: list[CaseSolution] = []
        self._lower, self._upper, self._middle = np.zeros((0, n)), np.zeros((0, n)), np.zeros((0, n))
        self._radius = np.zeros((0, 1))

    def append(self, found: CaseSolution, box: SolutionBox) -> None:
        self.found.append(found)
        self._lower, self._upper = np.vstack([self._lower, box.lower]), np.vstack([self._upper, box.upper])
        self._middle = np.vstack([self._middle, box.middle])
        self._radius = np.vstack([self._radius, [[box.radius]]])

    def near(self, box: SolutionBox) -> list[CaseSolution]:
        """Those that the box reaches within its radius, or that reach it within theirs."""
        low, high = self._middle - self._radius, self._middle + self._radius
        reach_it = np.all((box.upper >= low) & (box.lower <= high), axis=1)
        return [self.found[k] for k in np.flatnonzero(_meets(box, self._lower, self._upper) | reach_it)]


def _is_part(region: SystemBox, domain: SystemBox) -> bool:
    """Whether a box lies in another, and so do the ways in which its equations may hold."""
    if region.choice.shape != domain.choice.shape:
        return False
    first, end = region.choice.T
    ways = np.all((domain.choice[:, 0] <= first) & (first <= end) & (end <= domain.choice[:, 1]))
    return bool(ways) and is_part(region, domain)


def _exact_ends(lower: Array | Sequence[Fraction], upper: Array | Sequence[Fraction]) -> Ends:
    if len(lower) != len(upper):
        raise InputError("upper", "", f"must have as many ends as lower, {len(lower)}, not {len(upper)}")
    out = []
    for k, (low, high) in enumerate(zip(lower, upper, strict=True)):
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            raise InputError("lower, upper", f"unknown {k}", f"[{low}, {high}] is not a finite interval")
        out.append((Fraction(low), Fraction(high)))
    return out


def _products(equations: Sequence[ExactPolynomial | FactoredPolynomial], n: int) -> list[FactoredPolynomial]:
    """Equations as products, in the unknowns that the box has.

    Raises:
        InputError: an equation that is no polynomial, or has another unknown.
    """
    out = []
    for k, equation in enumerate(equations):
        if not isinstance(equation, FactoredPolynomial):
            check_instance(f"equations[{k}]", equation, dict, "a polynomial, as `parse_polynomial` gives it")
            equation = FactoredPolynomial.product([ExactPolynomial(equation)])
        for v in sorted(equation.variables - set(range(n))):
            raise InputError(f"equations[{k}]", "", f"has unknown {v}, but the box has {n}: 0 to {n - 1}")
        out.append(equation)
    return out


def _setup(
    equations: Sequence[FactoredPolynomial],
    ends: Ends,
    fixed: dict[int, Fraction],
    sigma: float | None,
    order: SearchOrder,
) -> SystemSetup:
    free = [pair for k, pair in enumerate(ends) if k not in fixed]
    parts = tuple(equation_parts(equations, free, fixed))
    if sigma is None:
        sigma = _DEFAULT_COVER_SIGMA if len(parts) < len(free) else _DEFAULT_SIGMA
    return SystemSetup(parts, free, sigma, order)
