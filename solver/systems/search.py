"""The search for all solutions of a polynomial system: what is known so far, and what the next slices are."""

import math
from collections.abc import Generator, Sequence
from contextlib import closing
from fractions import Fraction
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InputError
from ..certify import Ends, KnownSolutions, UniqueSolution, compile_kernels, enclosure
from ..interval import Interval
from ..polynomial import ExactPolynomial, normalised, substitute
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
from .worker import Isolator, IsolatorJob, IsolatorSetup, SliceOutcome, SolutionBox, SystemBox, is_late

__all__ = ["SystemSearch"]


# Boxes that were put off are split on as long as they do not multiply beyond this: isolated multiple
# solutions shrink to a few boxes each, whereas a curve of solutions would go on without end.
_MOST_LATE = 400
_DEFAULT_SIGMA = 1e-7
_DEFAULT_COVER_SIGMA = 0.05
# A young tree is searched box by box. As it grows, slices get larger and more of them may be under way, so
# that handing them to another process is worth while. No number here depends on how many processes there are.
_LARGEST_SLICE, _BOXES_PER_SIZE = 8, 32
_MOST_AHEAD, _BOXES_PER_SLICE_AHEAD = 32, 16


class SystemSearch:
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
        state: of branch and prune; its solutions are the boxes of the result, in the unknowns that are left.
        abandoned: boxes that were given up because every process that worked on them died.

    Raises:
        InputError: for a box whose ends are not finite, not as many, or crossed; a checkpoint that exists
            without `resume`, is damaged, belongs to another search, or can't be written.
    """

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
        compile_kernels()
        self._watch = Stopwatch()  # nobody's budget pays for compiling
        ends = _exact_ends(lower, upper)
        self._fixed = {k: low for k, (low, high) in enumerate(ends) if low == high}
        self._ends = ends
        self.setup = _setup(equations, ends, self._fixed, sigma, order)
        self._worker = Isolator(self.setup)
        self.state: SearchState[SystemBox, SolutionBox] = begin_at(
            [self._worker.root], order, self._worker.key, is_late
        )
        self.abandoned = 0
        self._known = KnownSolutions(self._worker.certifier)
        self._listed = _Listed(len(self.setup.ends))
        self._workers = workers
        self._checkpoint: Checkpoint | None = None
        if checkpoint is not None:
            key = fingerprint(equations, ends, self.setup)
            self._checkpoint = Checkpoint(checkpoint, "system", key, self._snapshot, self._restore)
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
    def solutions(self) -> tuple[SolutionBox, ...]:
        """The boxes of the result so far, in all unknowns."""
        return tuple(SolutionBox(*self._whole((s.lower, s.upper)), s.certified) for s in self.state.solutions)

    @property
    def undecided(self) -> tuple[Interval, ...]:
        """Boxes that may hold further solutions, those that are still open among them, in all unknowns."""
        left = self.state.undecided + self.state.open_regions
        return tuple(self._whole((box.lower, box.upper)) for box in left)

    def run(self) -> Generator["SystemSearch", None, None]:
        """Goes on; yields itself after each step until nothing is open, or splitting would have no end."""
        if self._is_endless():
            return
        slices = run_slices(
            self.state, self.setup, self._worker, self._workers, self._checkpoint,
            cut=self._cut, job=self._job, take_in=self._take_in, lookahead=self._lookahead,
        )  # fmt: skip
        with closing(slices):
            for _ in slices:
                yield self
                if self._is_endless():
                    return

    def _is_endless(self) -> bool:
        """Whether boxes that were put off are all that is left, and too many."""
        state = self.state
        if not state.is_late_next or not all(one.region.late for one in state.ahead):
            return False
        return state.n_open + sum(box.late for box in state.undecided) > _MOST_LATE

    def _cut(self, depth: int, box: SystemBox) -> Slice[SystemBox]:
        size = min(self.state.processed // _BOXES_PER_SIZE, _LARGEST_SLICE)
        # A box that was put off is split no further than is decided here, for it may go on without end.
        return Slice(box, depth, 1 if box.late else max(size, 1), effort=len(self._known))

    def _lookahead(self) -> int:
        return min(self.state.processed // _BOXES_PER_SLICE_AHEAD, _MOST_AHEAD)

    def _job(self, one: Slice[SystemBox]) -> IsolatorJob:
        """The slice with what was known near it when it was cut; the number is kept as its effort."""
        return IsolatorJob(one, self._known.first_near(one.effort, (one.region.lower, one.region.upper)))

    @np.errstate(all="ignore")
    def _take_in(self, outcome: SliceOutcome) -> Part[SystemBox, SolutionBox]:
        """Adds what became of a slice to what is known; solutions that are known already are left out."""
        self.abandoned += outcome.abandoned
        part = outcome.part
        solutions: list[SolutionBox] = []
        undecided: list[SystemBox] = []
        for found in part.solutions:
            if isinstance(found, SolutionBox):
                solutions.append(found)
            else:
                self._account_for(found, solutions, undecided)
        return Part(part.processed, solutions, undecided + part.undecided, part.decided, part.left)

    def _account_for(
        self, found: UniqueSolution, solutions: list[SolutionBox], undecided: list[SystemBox]
    ) -> None:
        """Puts a solution where it belongs, unless it is known."""
        same = self._known.holds(found.place, found.region)
        if same:
            return
        clipped = self._worker.asked.clip(found.place)
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

    def _snapshot(self) -> Snapshot:
        return snapshot(self.state, self._known, {"abandoned": self.abandoned, "seconds": self.seconds})

    def _restore(self, saved: Snapshot) -> None:
        """Takes up where a checkpoint was written."""
        counters, known = restore(saved, self.state)
        self.abandoned, self._watch.earlier_s = int(counters["abandoned"]), float(counters["seconds"])
        for solution in known:
            self._known.add(solution)
        for box in self.state.solutions if not self.setup.covers else ():
            self._listed.append(box)


class _Listed:
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
        raise InputError("the box", "", f"{len(lower)} lower and {len(upper)} upper ends")
    out = []
    for k, (low, high) in enumerate(zip(lower, upper, strict=True)):
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            raise InputError("the box", f"unknown {k}", f"[{low}, {high}] is not a finite interval")
        out.append((Fraction(low), Fraction(high)))
    return out


def _setup(
    equations: Sequence[ExactPolynomial],
    ends: Ends,
    fixed: dict[int, Fraction],
    sigma: float | None,
    order: SearchOrder,
) -> IsolatorSetup:
    reduced = tuple(normalised(e) for e in (substitute(e, fixed) for e in equations) if e)
    free = [pair for k, pair in enumerate(ends) if k not in fixed]
    if sigma is None:
        sigma = _DEFAULT_COVER_SIGMA if len(reduced) < len(free) else _DEFAULT_SIGMA
    return IsolatorSetup(reduced, free, sigma, order)
