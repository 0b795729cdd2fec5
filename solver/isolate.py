"""All real solutions of a polynomial system in a box: each one proved, or a proof that there are none.

For as many equations as unknowns the solutions are isolated one by one: a box counts as solved once the
interval Newton test shows that it holds exactly one. For fewer equations the solution set is covered by small
boxes.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .certifier import Interval, compile_kernels
from .exact_system import normalised, substitute
from .expression import ExactPolynomial
from .isolator import Isolator, SolutionBox
from .native import enclose_fraction
from .search import SearchOrder, SearchState, branch_and_prune

__all__ = ["Isolation", "IsolationProgress", "IsolationVerdict", "SolutionBox", "isolate"]

Array = NDArray[np.float64]
Box = list[tuple[Fraction, Fraction]]

# Deferred boxes are split on as long as they do not multiply beyond this: isolated multiple solutions shrink
# to a few boxes each, whereas a curve of solutions would go on without end.
_MOST_DEFERRED = 400
_DEFAULT_SIGMA = 1e-7
_DEFAULT_COVER_SIGMA = 0.05


class IsolationVerdict(Enum):
    """What is known of all solutions in the box."""

    COMPLETE = "complete"
    INFEASIBLE = "infeasible"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class IsolationProgress:
    """Where a running search stands.

    Attributes:
        processed: boxes processed.
        open: boxes still to be processed.
        solved: solutions, or boxes of the cover, so far.
    """

    processed: int
    open: int
    solved: int


@dataclass(frozen=True, eq=False)
class Isolation:
    """The outcome of `isolate`.

    Attributes:
        verdict: COMPLETE: every solution lies in one of the boxes, and for square systems each box is
            certified, holds exactly one, and no other within its radius. INFEASIBLE: proved that there is
            none. UNDECIDED: neither; also where boxes cover all solutions, but none is proved to hold one.
        solutions: certified boxes of square systems; the cover, certified or not, where there are fewer
            equations than unknowns.
        undecided: boxes that may hold further solutions.
        processed: boxes processed.
        sigma: width below which a box is not split.
        seconds: time taken.
        covers: True where there are fewer equations than unknowns, so that boxes cover the solution set.
    """

    verdict: IsolationVerdict
    solutions: tuple[SolutionBox, ...]
    undecided: tuple[Interval, ...]
    processed: int
    sigma: float
    seconds: float
    covers: bool


def isolate(
    equations: Sequence[ExactPolynomial],
    lower: Array | Sequence[Fraction],
    upper: Array | Sequence[Fraction],
    *,
    sigma: float | None = None,
    budget_s: float = 60.0,
    on_step: Callable[[IsolationProgress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Isolation:
    """Finds all solutions of `equations` in the closed box [lower, upper].

    Unknowns whose interval is a point are replaced by their value, exactly, and don't count as unknowns.

    Args:
        equations: polynomials that must be zero.
        lower: (n,) finite lower ends, each taken exactly.
        upper: (n,) finite upper ends.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        budget_s: time after which the search stops; what is left counts as undecided.
        on_step: called after each box.
        should_stop: asked after each box; the search stops where it answers True.

    Raises:
        InputError: for a box whose ends are not finite, not as many, or crossed.
    """
    compile_kernels()
    started = time.perf_counter()
    box = _exact_box(lower, upper)
    fixed = {k: low for k, (low, high) in enumerate(box) if low == high}
    free = [ends for k, ends in enumerate(box) if k not in fixed]
    reduced = [normalised(e) for e in (substitute(e, fixed) for e in equations) if e]
    if sigma is None:
        sigma = _DEFAULT_COVER_SIGMA if len(reduced) < len(free) else _DEFAULT_SIGMA
    # Overflow is part of the arithmetic, which is on the safe side of it.
    with np.errstate(all="ignore"):
        if any(set(e) == {()} for e in reduced):
            result = _outcome([], [], 0, sigma, covers=False)  # a number other than zero must be zero
        elif not reduced:
            whole = SolutionBox(*_enclosure(free), certified=True)
            result = _outcome([whole], [], 0, sigma, covers=bool(free))
        else:
            result = _search(reduced, free, sigma, started + budget_s, on_step, should_stop)
        result = _with_fixed(result, box, fixed)
    return replace(result, seconds=time.perf_counter() - started)


def _exact_box(lower: Array | Sequence[Fraction], upper: Array | Sequence[Fraction]) -> Box:
    if len(lower) != len(upper):
        raise InputError("the box", "", f"{len(lower)} lower and {len(upper)} upper ends")
    out = []
    for k, (low, high) in enumerate(zip(lower, upper, strict=True)):
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            raise InputError("the box", f"unknown {k}", f"[{low}, {high}] is not a finite interval")
        out.append((Fraction(low), Fraction(high)))
    return out


def _enclosure(box: Box) -> Interval:
    lower = np.array([enclose_fraction(low)[0] for low, _ in box], dtype=np.float64)
    upper = np.array([enclose_fraction(high)[1] for _, high in box], dtype=np.float64)
    return lower, upper


def _search(
    equations: list[ExactPolynomial],
    box: Box,
    sigma: float,
    deadline: float,
    on_step: Callable[[IsolationProgress], None] | None,
    should_stop: Callable[[], bool] | None,
) -> Isolation:
    worker = Isolator(equations, box, _enclosure(box), sigma)
    solutions: list[SolutionBox] = []
    left: list[Interval] = []
    processed = 0
    roots: list[Interval] = [worker.root]
    stopped = False
    for deferred, order in ((False, SearchOrder.DEPTH_FIRST), (True, SearchOrder.BREADTH_FIRST)):
        state: SearchState[Interval, SolutionBox] = SearchState()
        process = worker.process_deferred if deferred else worker.process
        for state in branch_and_prune(roots, process, order):
            if on_step is not None:
                found = len(solutions) + len(state.solutions)
                on_step(IsolationProgress(processed + state.processed, len(state.frontier), found))
            endless = deferred and len(state.frontier) + len(state.undecided) > _MOST_DEFERRED
            stopped = time.perf_counter() > deadline or (should_stop is not None and should_stop())
            if endless or stopped:
                break
        processed += state.processed
        solutions += state.solutions
        left += state.undecided + [entry[-1] for entry in state.frontier]
        roots, worker.deferred = worker.deferred, []
        if stopped:
            break
    return _outcome(solutions, left + roots, processed, sigma, covers=len(equations) < len(box))


def _outcome(
    solutions: list[SolutionBox], left: list[Interval], processed: int, sigma: float, *, covers: bool
) -> Isolation:
    if left or (solutions and not any(box.certified for box in solutions)):
        verdict = IsolationVerdict.UNDECIDED
    else:
        verdict = IsolationVerdict.COMPLETE if solutions else IsolationVerdict.INFEASIBLE
    return Isolation(verdict, tuple(solutions), tuple(left), processed, sigma, 0.0, covers)


def _with_fixed(result: Isolation, box: Box, fixed: dict[int, Fraction]) -> Isolation:
    """The same with the unknowns whose interval is a point put back."""
    if not fixed:
        return result
    whole = _enclosure(box)
    free = np.array([k not in fixed for k in range(len(box))], dtype=bool)

    def widened(inner: Interval) -> Interval:
        lower, upper = whole[0].copy(), whole[1].copy()
        lower[free], upper[free] = inner
        return lower, upper

    solutions = tuple(SolutionBox(*widened((s.lower, s.upper)), s.certified) for s in result.solutions)
    return replace(result, solutions=solutions, undecided=tuple(widened(b) for b in result.undecided))
