"""All real solutions of a polynomial system in a box: each one proved, or a proof that there are none.

For as many equations as unknowns the solutions are isolated one by one: a box counts as solved once the
interval Newton test shows that it holds exactly one. For fewer equations the solution set is covered by small
boxes.
"""

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from pathlib import Path

from ...arrays import Array
from ..interval import Interval
from ..polynomial import ExactPolynomial
from ..search import SearchOrder
from .search import SystemSearch
from .worker import SolutionBox

__all__ = [
    "Isolation",
    "IsolationProgress",
    "IsolationVerdict",
    "SolutionBox",
    "isolate",
    "iterate_system",
]


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
        undecided: boxes that may hold further solutions, but are not split any more.
        depth: splits above the deepest box.
        decided: share of the initial box that is decided, by number of splits.
        seconds: time since the start.
    """

    processed: int
    open: int
    solved: int
    undecided: int
    depth: int
    decided: float
    seconds: float

    @classmethod
    def of(cls, search: SystemSearch) -> "IsolationProgress":
        """Where a search stands."""
        state = search.state
        return cls(
            state.processed,
            state.n_open,
            len(state.solutions),
            len(state.undecided),
            state.depth,
            state.decided,
            search.seconds,
        )


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
        decided: share of the initial box that is decided, by number of splits.
        abandoned: those of the undecided boxes that were given up because every process that worked on them
            died.
    """

    verdict: IsolationVerdict
    solutions: tuple[SolutionBox, ...]
    undecided: tuple[Interval, ...]
    processed: int
    sigma: float
    seconds: float
    covers: bool
    decided: float = 1.0
    abandoned: int = 0

    @classmethod
    def of(cls, search: SystemSearch) -> "Isolation":
        """What a search has found so far."""
        solutions, undecided = search.solutions, search.undecided
        if undecided or (solutions and not any(box.certified for box in solutions)):
            verdict = IsolationVerdict.UNDECIDED
        else:
            verdict = IsolationVerdict.COMPLETE if solutions else IsolationVerdict.INFEASIBLE
        return cls(
            verdict,
            solutions,
            undecided,
            search.state.processed,
            search.setup.sigma,
            search.seconds,
            search.setup.covers,
            search.state.decided,
            search.abandoned,
        )


def iterate_system(
    equations: Sequence[ExactPolynomial],
    lower: Array | Sequence[Fraction],
    upper: Array | Sequence[Fraction],
    *,
    sigma: float | None = None,
    order: SearchOrder = SearchOrder.DEPTH_FIRST,
    workers: int = 1,
    checkpoint: str | Path | None = None,
    resume: bool = False,
) -> Generator[SystemSearch, None, None]:
    """The search for all solutions in the closed box [lower, upper], step by step; leave it at any of them.

    The same search is yielded after each step, a box or a few. `IsolationProgress.of` and `Isolation.of` sum
    it up; at any moment every solution lies in one of the boxes of the latter. Close the iterator, or let go
    of it, to end its processes.

    Args:
        equations: polynomials that must be zero.
        lower: (n,) finite lower ends, each taken exactly.
        upper: (n,) finite upper ends.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        order: which box comes next; best first takes the one that Newton's method leaves least, in widths of
            the box, with a step from its middle.
        workers: processes to use, once the search has turned out to take longer than they need to start;
            their number has no influence on the result.
        checkpoint: file to which the search is written every few seconds and when it ends or is left.
        resume: go on from that file, if there is one.

    Raises:
        InputError: see `SystemSearch`.
    """
    return SystemSearch(
        equations, lower, upper,
        sigma=sigma, order=order, workers=workers, checkpoint=checkpoint, resume=resume,
    ).run()  # fmt: skip


def isolate(
    equations: Sequence[ExactPolynomial],
    lower: Array | Sequence[Fraction],
    upper: Array | Sequence[Fraction],
    *,
    sigma: float | None = None,
    budget_s: float = 60.0,
    order: SearchOrder = SearchOrder.DEPTH_FIRST,
    workers: int = 1,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_step: Callable[[IsolationProgress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Isolation:
    """Finds all solutions of `equations` in the closed box [lower, upper].

    Unknowns whose interval is a point are replaced by their value, exactly, and don't count as unknowns.

    Args:
        equations: polynomials that must be zero.
        lower: (n,) finite lower ends, each taken exactly.
        upper: (n,) finite upper ends.
        sigma: see `iterate_system`, as for all that is not explained here.
        budget_s: time after which the search stops; what is left counts as undecided.
        order: see `iterate_system`.
        workers: see `iterate_system`.
        checkpoint: see `iterate_system`.
        resume: see `iterate_system`.
        on_step: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: see `SystemSearch`.
    """
    search = SystemSearch(
        equations, lower, upper,
        sigma=sigma, order=order, workers=workers, checkpoint=checkpoint, resume=resume,
    )  # fmt: skip
    with closing(search.run()) as steps:
        for _ in steps:
            if on_step is not None:
                on_step(IsolationProgress.of(search))
            if search.seconds_here > budget_s or (should_stop is not None and should_stop()):
                break
    return Isolation.of(search)
