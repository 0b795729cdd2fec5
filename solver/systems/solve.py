"""All real solutions of a polynomial system in a box: each one proved, or a proof that there are none.

For as many equations as unknowns the solutions are isolated one by one: a box counts as solved once the
interval Newton test shows that it holds exactly one. For fewer equations the solution set is covered by small
boxes.
"""

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import overload

from ...arguments import check_budget
from ...base.numeric.arrays import Array
from ...base.text.notebook import html_table
from ...base.text.plain_text import counted
from ..interval import Interval
from ..polynomial import ExactPolynomial, FactoredPolynomial
from ..search import Progress, SearchOrder, SearchResult, Verdict
from .search import SystemSearch
from .worker import SolutionBox

__all__ = ["SystemResult", "iterate_system", "solve_system"]


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SystemResult(SearchResult):
    """The outcome of `solve_system`: a sequence of solutions, and what else became known.

    Attributes:
        verdict: COMPLETE: every solution lies in one of the boxes, and for square systems each box is
            certified, holds exactly one, and no other within its radius. INFEASIBLE: proved that there is
            none. UNDECIDED: neither; also where boxes cover all solutions, but none is proved to hold one.
        solutions: certified boxes of square systems; the cover, certified or not, where there are fewer
            equations than unknowns.
        remaining: boxes that may hold further solutions, the undecided ones and the open ones.
        covers: True where there are fewer equations than unknowns, so that boxes cover the solution set.
    """

    solutions: tuple[SolutionBox, ...]
    remaining: tuple[Interval, ...]
    covers: bool

    @classmethod
    def of(cls, search: SystemSearch) -> "SystemResult":
        """What a search has found so far."""
        solutions, remaining = search.solutions, search.remaining
        if remaining or (solutions and not any(box.certified for box in solutions)):
            verdict = Verdict.UNDECIDED
        else:
            verdict = Verdict.COMPLETE if solutions else Verdict.INFEASIBLE
        return cls(
            verdict=verdict,
            progress=search.progress,
            sigma=search.setup.sigma,
            abandoned=search.abandoned,
            solutions=solutions,
            remaining=remaining,
            covers=search.setup.covers,
        )

    def __len__(self) -> int:
        return len(self.solutions)

    def __iter__(self) -> Iterator[SolutionBox]:
        return iter(self.solutions)

    @overload
    def __getitem__(self, index: int) -> SolutionBox: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[SolutionBox, ...]: ...
    def __getitem__(self, index: int | slice) -> SolutionBox | tuple[SolutionBox, ...]:
        return self.solutions[index]

    def __str__(self) -> str:
        if self.covers:
            return self.summary(f"a cover of {counted(len(self), 'box', 'boxes')}")
        return self.summary(counted(len(self), "certified solution"))

    def _repr_html_(self) -> str:
        n = self.solutions[0].middle.size if self.solutions else 0
        head = [*(f"x{k}" for k in range(n)), "radius", "certified"]
        rows = [
            (*box.middle.tolist(), box.radius, "yes" if box.certified else "no") for box in self.solutions
        ]
        return html_table(str(self), head, rows)


def iterate_system(
    equations: Sequence[ExactPolynomial | FactoredPolynomial],
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

    The same search is yielded after each step, a box or a few. Its `progress` says where it stands, and
    `SystemResult.of` sums it up; at any moment every solution lies in one of the boxes of the latter. Close
    the iterator, or let go of it, to end its processes.

    Args:
        equations: polynomials, or products of them, that must be zero.
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
        InputError: an argument that can't be used; a checkpoint, see `SystemSearch`.
    """
    return SystemSearch(
        equations, lower, upper,
        sigma=sigma, order=order, workers=workers, checkpoint=checkpoint, resume=resume,
    ).run()  # fmt: skip


def solve_system(
    equations: Sequence[ExactPolynomial | FactoredPolynomial],
    lower: Array | Sequence[Fraction],
    upper: Array | Sequence[Fraction],
    *,
    sigma: float | None = None,
    budget_s: float = 60.0,
    order: SearchOrder = SearchOrder.DEPTH_FIRST,
    workers: int = 1,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> SystemResult:
    """Finds all solutions of `equations` in the closed box [lower, upper].

    Unknowns whose interval is a point are replaced by their value, exactly, and don't count as unknowns.

    Args:
        equations: polynomials, or products of them, that must be zero.
        lower: (n,) finite lower ends, each taken exactly.
        upper: (n,) finite upper ends.
        sigma: boxes narrower than this are not split; 1e-7, or 0.05 where there are fewer equations than
            unknowns, unless given.
        budget_s: time after which the search stops, `inf` for no limit; what is open then remains.
        order: which box comes next; best first takes the one that Newton's method leaves least, in widths of
            the box, with a step from its middle.
        workers: processes to use, once the search has turned out to take longer than they need to start;
            their number has no influence on the result.
        checkpoint: file to which the search is written every few seconds and when it ends.
        resume: go on from that file, if there is one.
        on_progress: called after each step.
        should_stop: asked after each step; the search stops where it answers True.

    Raises:
        InputError: an argument that can't be used; a checkpoint, see `SystemSearch`.
    """
    budget_s = check_budget("budget_s", budget_s)
    search = SystemSearch(
        equations, lower, upper,
        sigma=sigma, order=order, workers=workers, checkpoint=checkpoint, resume=resume,
    )  # fmt: skip
    search.finish(budget_s=budget_s, should_stop=should_stop, on_progress=on_progress)
    return SystemResult.of(search)
