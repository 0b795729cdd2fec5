"""All real solutions of a polynomial system in a box: each one proved, or a proof that there are none.

For as many equations as unknowns the solutions are isolated one by one: a box counts as solved once the
interval Newton test shows that it holds exactly one. For fewer equations the solution set is covered by small
boxes.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .contract_native import CERTIFIED, EMPTY, contract_native, harm, square_inverse
from .expression import ExactPolynomial
from .native import native_system, newton_step, values_and_slopes
from .search import Outcome, SearchOrder, SearchState, branch_and_prune

__all__ = ["Isolation", "IsolationProgress", "IsolationVerdict", "SolutionBox", "isolate"]

Array = NDArray[np.float64]
Interval = tuple[Array, Array]

_SLICES = 8  # by the counts of `benchmarks/systems.py`: fewer prune less, more cost more than they save
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


@dataclass(frozen=True, eq=False)
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

    @property
    def middle(self) -> Array:
        """Middle (n,) of the box."""
        return 0.5 * (self.lower + self.upper)

    @property
    def radius(self) -> float:
        """A number such that every point of the box is within it of the middle, in every variable."""
        middle = self.middle
        return float(np.nextafter(np.maximum(self.upper - middle, middle - self.lower).max(), np.inf))


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
            certified and holds exactly one. INFEASIBLE: proved that there is none. UNDECIDED: neither.
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
    lower: Array,
    upper: Array,
    *,
    sigma: float | None = None,
    budget_s: float = 60.0,
    on_step: Callable[[IsolationProgress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Isolation:
    """Finds all solutions of `equations` in the box [lower, upper].

    Args:
        equations: polynomials that must be zero.
        lower: (n,) finite lower ends.
        upper: (n,) finite upper ends.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        budget_s: time after which the search stops; what is left counts as undecided.
        on_step: called after each box.
        should_stop: asked after each box; the search stops where it answers True.
    """
    started = time.perf_counter()
    worker = _Isolator(equations, lower, upper, sigma)
    solutions: list[SolutionBox] = []
    left: list[Interval] = []
    processed = 0
    phases = ((worker.process, SearchOrder.DEPTH_FIRST), (worker.process_deferred, SearchOrder.BREADTH_FIRST))
    roots = [(lower.copy(), upper.copy())]
    for number, (process, order) in enumerate(phases):
        state: SearchState[Interval, SolutionBox] = SearchState()
        for state in branch_and_prune(roots, process, order):
            if on_step is not None:
                found = len(solutions) + len(state.solutions)
                on_step(IsolationProgress(processed + state.processed, len(state.frontier), found))
            endless = number == 1 and len(state.frontier) + len(state.undecided) > _MOST_DEFERRED
            late = time.perf_counter() - started > budget_s
            if endless or late or (should_stop is not None and should_stop()):
                break
        processed += state.processed
        solutions += state.solutions
        left += state.undecided + [entry[-1] for entry in state.frontier]
        roots, worker.deferred = worker.deferred, []
    left += roots
    return Isolation(
        _verdict(solutions, left),
        tuple(solutions),
        tuple(left),
        processed,
        worker.sigma,
        time.perf_counter() - started,
        len(equations) < len(lower),
    )


def _verdict(solutions: list[SolutionBox], left: list[Interval]) -> IsolationVerdict:
    if left:
        return IsolationVerdict.UNDECIDED
    return IsolationVerdict.COMPLETE if solutions else IsolationVerdict.INFEASIBLE


class _Isolator:
    """What branch and prune does with a box of a polynomial system."""

    def __init__(self, equations: Sequence[ExactPolynomial], lower: Array, upper: Array, sigma: float | None):
        m, n = len(equations), len(lower)
        self.m, self.n = m, n
        self.root = (lower.copy(), upper.copy())
        default = _DEFAULT_COVER_SIGMA if m < n else _DEFAULT_SIGMA
        self.sigma = default if sigma is None else sigma
        self.deferred: list[Interval] = []
        self._system = native_system(equations, n)
        self._unique: list[Interval] = []  # boxes with exactly one solution each, all recorded
        self._workspace = (
            *(np.zeros(m) for _ in range(2)),
            *(np.zeros((m, n)) for _ in range(4)),
            *(np.zeros((m, n, n)) for _ in range(2)),
        )

    def process(self, box: Interval) -> Outcome[Interval, SolutionBox]:
        """Contracts a box; certifies, splits, or puts it aside where a multiple solution is in the way."""
        return self._process(box, may_defer=True)

    def process_deferred(self, box: Interval) -> Outcome[Interval, SolutionBox]:
        """The same for boxes that were put aside."""
        return self._process(box, may_defer=False)

    def _process(self, box: Interval, *, may_defer: bool) -> Outcome[Interval, SolutionBox]:
        lower, upper = box[0].copy(), box[1].copy()
        if self._is_solved(lower, upper):
            return Outcome()
        status = contract_native(self._system, lower, upper, self._workspace, _SLICES)
        if status == EMPTY or self._is_solved(lower, upper):
            return Outcome()
        if self.m < self.n:
            return self._cover(lower, upper)
        if status == CERTIFIED:
            return Outcome(self._record(lower, upper))
        if np.max(upper - lower) <= self.sigma:
            found = self._record_around(lower, upper)
            return Outcome(undecided=(lower, upper)) if found is None else Outcome(found)
        if may_defer and self._is_singular(lower, upper):
            self.deferred.append((lower, upper))
            return Outcome()
        return Outcome(children=self._split(lower, upper))

    def _is_solved(self, lower: Array, upper: Array) -> bool:
        """Whether the box lies in one whose only solution is recorded."""
        return any(np.all(lower >= low) and np.all(upper <= high) for low, high in self._unique)

    def _cover(self, lower: Array, upper: Array) -> Outcome[Interval, SolutionBox]:
        """Fewer equations than unknowns: small boxes make up the result."""
        if np.max(upper - lower) > self.sigma:
            return Outcome(children=self._split(lower, upper))
        return Outcome([SolutionBox(lower, upper, self._holds_point(lower, upper))])

    def _slopes(self, lower: Array, upper: Array) -> tuple[Array, Array, Array, Array]:
        out = np.zeros(self.m), np.zeros(self.m), np.zeros((self.m, self.n)), np.zeros((self.m, self.n))
        values_and_slopes(self._system, lower, upper, *out)
        return out

    def _middle_slopes(self, x: Array) -> tuple[Array, Array]:
        f_lower, f_upper, J_lower, J_upper = self._slopes(x, x)
        return 0.5 * (f_lower + f_upper), 0.5 * (J_lower + J_upper)

    def _approximate(self, x: Array) -> Array | None:
        """Newton's method from x, least-norm where the Jacobian is not square or singular."""
        for _ in range(8):
            f, J = self._middle_slopes(x)
            if not (np.isfinite(f).all() and np.isfinite(J).all()):
                return None
            step = np.linalg.lstsq(J, -f, rcond=1e-10)[0]
            x = x + step
            if np.abs(step).max(initial=0.0) < 1e-13 * (1.0 + np.abs(x).max()):
                return x
        return None

    def _is_singular(self, lower: Array, upper: Array) -> bool:
        """Whether the box seems to hold a solution at which the Jacobian loses rank (a guess, no proof)."""
        if np.any(upper - lower > 0.1 * (1.0 + np.abs(upper))):
            return False
        x = self._approximate(0.5 * (lower + upper))
        room = upper - lower
        if x is None or np.any(x < lower - room) or np.any(x > upper + room):
            return False
        values = np.linalg.svd(self._middle_slopes(x)[1], compute_uv=False)
        return bool(values[-1] <= 1e-6 * values[0])

    def _test(self, x: Array, lower: Array, upper: Array) -> tuple[bool, Array, Array]:
        """The Newton test on [lower, upper] around x: whether it succeeds, and the narrowed box."""
        k = min(self.m, self.n)
        rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
        Y = np.empty((k, self.m))
        f_lower, f_upper, J0_lower, J0_upper = self._slopes(x, x)
        low, high = lower.copy(), upper.copy()
        weight = np.maximum(upper - lower, 1e-300)
        if self.m > self.n or not square_inverse(0.5 * (J0_lower + J0_upper), weight, rows, columns, Y):
            return False, low, high
        _, _, J_lower, J_upper = self._slopes(lower, upper)
        status = newton_step(x, low, high, columns, Y, f_lower, f_upper, J_lower, J_upper)
        return bool(status == CERTIFIED), low, high

    def _holds_point(self, lower: Array, upper: Array) -> bool:
        """Whether a solution is proved in the box: with all but m variables held at a point's values."""
        x = self._approximate(0.5 * (lower + upper))
        if x is None:
            return False
        x = np.clip(x, lower, upper)
        k = self.m
        rows, columns = np.empty(k, dtype=np.int64), np.empty(k, dtype=np.int64)
        _, J = self._middle_slopes(x)
        if not square_inverse(J, upper - lower, rows, columns, np.empty((k, self.m))):
            return False
        low, high = x.copy(), x.copy()
        room = 1e-10 * (1.0 + np.abs(x[columns]))
        low[columns] = np.maximum(lower[columns], x[columns] - room)
        high[columns] = np.minimum(upper[columns], x[columns] + room)
        return self._test(x, low, high)[0]

    def _record(self, lower: Array, upper: Array) -> list[SolutionBox]:
        """Records the only solution of [lower, upper], unless it is known already."""
        low, high = lower, upper
        for _ in range(30):
            width = high - low
            _, low, high = self._test(0.5 * (low + high), low, high)
            if np.all(high - low > 0.5 * width):
                break
        if any(np.all(low >= known[0]) and np.all(high <= known[1]) for known in self._unique):
            return []
        self._unique.append(self._widest_unique(0.5 * (low + high)) or (lower, upper))
        # A solution found around a box on the rim may lie outside the box that was asked for.
        if np.any(high < self.root[0]) or np.any(low > self.root[1]):
            return []
        return [SolutionBox(low, high, True)]

    def _widest_unique(self, x: Array) -> Interval | None:
        """The widest box tried around the approximate solution x in which exactly one solution is proved."""
        best = None
        radius = np.maximum(1e-12 * (1.0 + np.abs(x)), 1e-10 * (self.root[1] - self.root[0]))
        for _ in range(50):
            if not self._test(x, x - radius, x + radius)[0]:
                break
            best = (x - radius, x + radius)
            radius = 2.0 * radius
        return best

    def _record_around(self, lower: Array, upper: Array) -> list[SolutionBox] | None:
        """For a small box on whose face a solution may lie: solves the box around it; None without proof."""
        x = self._approximate(0.5 * (lower + upper)) if self.m == self.n else None
        wide = None if x is None else self._widest_unique(x)
        if wide is None or not (np.all(wide[0] <= lower) and np.all(wide[1] >= upper)):
            return None
        return self._record(*wide)

    def _split(self, lower: Array, upper: Array) -> tuple[Interval, Interval]:
        """Two halves, cut across the variable whose width does most harm to the second-order expansion."""
        width = upper - lower
        score = width if self.m < self.n else harm(self._system, lower, upper, self._workspace)
        score = np.where(width > 1e-13 * np.maximum(1.0, np.abs(upper)), score, -1.0)
        k = int(np.argmax(score))
        at = lower[k] + 0.4871 * width[k]  # off the middle: solutions like to sit on symmetric places
        left, right = upper.copy(), lower.copy()
        left[k] = right[k] = at
        return (lower, left), (right, upper)
