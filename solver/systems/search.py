"""The search for all solutions of a polynomial system: what is known, and what is handed to workers."""

import math
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np

from ...arguments import check_instance, check_number, check_whole_number
from ...arrays import Array
from ...errors import InputError
from ..certify import Ends, KnownSolutions, UniqueSolution, compile_kernels, enclosure
from ..interval import Interval
from ..polynomial import ExactPolynomial, normalised, substitute
from ..search import (
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
from .checkpoint import fingerprint, restore, snapshot
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
        equations: polynomials that must be zero.
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
        equations: Sequence[ExactPolynomial],
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
        _check_unknowns(equations, len(self._ends))
        self._fixed = {k: low for k, (low, high) in enumerate(self._ends) if low == high}
        setup = _setup(equations, self._ends, self._fixed, sigma, order)
        worker = SystemWorker(setup)
        state: SearchState[SystemBox, SolutionBox] = begin_at([worker.root], order, worker.key, is_postponed)
        super().__init__(setup, worker, state, workers=workers, watch=watch)
        self._known = KnownSolutions(worker.certifier)
        self._listed = _SolutionBoxes(len(setup.ends))
        if checkpoint is not None:
            key = fingerprint(equations, self._ends, setup)
            self.keep_in(
                checkpoint, what="system", fingerprint=key, kind=SystemBox, is_part=is_part, resume=resume
            )

    @property
    def solutions(self) -> tuple[SolutionBox, ...]:
        """The boxes of the result so far, in all unknowns."""
        return tuple(SolutionBox(*self._whole((s.lower, s.upper)), s.certified) for s in self.state.solutions)

    @property
    def remaining(self) -> tuple[Interval, ...]:
        """Boxes that may hold further solutions, those that are still open among them, in all unknowns."""
        left = self.state.undecided + self.state.open_regions
        return tuple(self._whole((box.lower, box.upper)) for box in left)

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
        return SystemJob(subtree, self._known.first_near(subtree.context, box))

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
        self, found: UniqueSolution, solutions: list[SolutionBox], undecided: list[SystemBox]
    ) -> None:
        """Puts a solution where it belongs, unless it is known."""
        same = self._known.holds(found.place, found.region)
        if same:
            return
        clipped = self.worker.asked.clip(found.place)
        if same is not None:
            self._known.add(found)
            box = SolutionBox(*clipped, certified=True)
            if found.inside is False:
                return
            if found.inside and self._listed.is_apart(box):
                self._listed.append(box)
                solutions.append(box)
                return
        undecided.append(SystemBox(*clipped))

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
        for solution in known:
            self._known.add(solution)
        for box in self.state.solutions if not self.setup.covers else ():
            self._listed.append(box)


class _SolutionBoxes:
    """The solution boxes of the result, stacked."""

    def __init__(self, n: int):
        self._lower, self._upper, self._middle = np.zeros((0, n)), np.zeros((0, n)), np.zeros((0, n))
        self._radius = np.zeros((0, 1))

    def append(self, box: SolutionBox) -> None:
        self._lower, self._upper = np.vstack([self._lower, box.lower]), np.vstack([self._upper, box.upper])
        self._middle = np.vstack([self._middle, box.middle])
        self._radius = np.vstack([self._radius, [[box.radius]]])

    def is_apart(self, box: SolutionBox) -> bool:
        """Whether neither the box nor any of those listed reaches within the radius of the other."""
        low, high = box.middle - box.radius, box.middle + box.radius
        out_of_its_reach = np.any((self._upper < low) | (self._lower > high), axis=1)
        low, high = self._middle - self._radius, self._middle + self._radius
        out_of_theirs = np.any((box.upper < low) | (box.lower > high), axis=1)
        return bool(np.all(out_of_its_reach & out_of_theirs))


def _exact_ends(lower: Array | Sequence[Fraction], upper: Array | Sequence[Fraction]) -> Ends:
    if len(lower) != len(upper):
        raise InputError("upper", "", f"must have as many ends as lower, {len(lower)}, not {len(upper)}")
    out = []
    for k, (low, high) in enumerate(zip(lower, upper, strict=True)):
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            raise InputError("lower, upper", f"unknown {k}", f"[{low}, {high}] is not a finite interval")
        out.append((Fraction(low), Fraction(high)))
    return out


def _check_unknowns(equations: Sequence[ExactPolynomial], n: int) -> None:
    """Sees to it that equations speak of the unknowns that the box has.

    Raises:
        InputError: an equation that is no polynomial, or has another unknown.
    """
    for k, equation in enumerate(equations):
        check_instance(f"equations[{k}]", equation, dict, "a polynomial, as `parse_polynomial` gives it")
        unknowns = {v for monomial in equation for v, _ in monomial}
        for v in sorted(unknowns - set(range(n))):
            raise InputError(f"equations[{k}]", "", f"has unknown {v}, but the box has {n}: 0 to {n - 1}")


def _setup(
    equations: Sequence[ExactPolynomial],
    ends: Ends,
    fixed: dict[int, Fraction],
    sigma: float | None,
    order: SearchOrder,
) -> SystemSetup:
    reduced = tuple(normalised(e) for e in (substitute(e, fixed) for e in equations) if e)
    free = [pair for k, pair in enumerate(ends) if k not in fixed]
    if sigma is None:
        sigma = _DEFAULT_COVER_SIGMA if len(reduced) < len(free) else _DEFAULT_SIGMA
    return SystemSetup(reduced, free, sigma, order)
