"""Branch and prune: the loop, which knows nothing of what is searched.

A region is taken from the frontier and given to `process`, which says what became of it: nothing,
solutions, smaller regions, or a remainder that is too small to go on with. The search is an iterator of
its own states, so that budgets, progress and "stop at the first" live with the caller.
"""

import heapq
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Generic, TypeVar

__all__ = ["Outcome", "SearchOrder", "SearchState", "branch_and_prune"]

RegionT = TypeVar("RegionT")
SolutionT = TypeVar("SolutionT")


class SearchOrder(Enum):
    """Which region of the frontier comes next."""

    DEPTH_FIRST = "depth first"
    BREADTH_FIRST = "breadth first"


@dataclass(frozen=True)
class Outcome(Generic[RegionT, SolutionT]):
    """What became of a region.

    Attributes:
        solutions: what was found in it.
        children: regions that together hold every solution that it may still hold; the first is taken first.
        undecided: the region itself, where it may hold solutions but is too small to be split.
    """

    solutions: Sequence[SolutionT] = ()
    children: Sequence[RegionT] = ()
    undecided: RegionT | None = None


@dataclass
class SearchState(Generic[RegionT, SolutionT]):
    """Where a search stands; the same object is updated from step to step.

    Attributes:
        processed: number of regions taken from the frontier.
        frontier: (priority, number, depth, region) of the regions still to be taken.
        solutions: everything found.
        undecided: regions left over.
        decided: share of the roots that is decided, in [0, 1]: 2^-depth for each leaf.
    """

    processed: int = 0
    frontier: list[tuple[int, int, int, RegionT]] = field(default_factory=list)
    solutions: list[SolutionT] = field(default_factory=list)
    undecided: list[RegionT] = field(default_factory=list)
    decided: float = 0.0


def branch_and_prune(
    roots: Sequence[RegionT],
    process: Callable[[RegionT], Outcome[RegionT, SolutionT]],
    order: SearchOrder = SearchOrder.DEPTH_FIRST,
) -> Iterator[SearchState[RegionT, SolutionT]]:
    """Yields the state after each region until the frontier is empty."""
    state: SearchState[RegionT, SolutionT] = SearchState(
        frontier=[(0, number, 0, root) for number, root in enumerate(roots)]
    )
    number = len(roots)
    while state.frontier:
        _, _, depth, region = heapq.heappop(state.frontier)
        outcome = process(region)
        state.processed += 1
        state.solutions.extend(outcome.solutions)
        if outcome.undecided is not None:
            state.undecided.append(outcome.undecided)
        if not outcome.children:
            state.decided += 0.5**depth / len(roots)
        sign = 1 if order is SearchOrder.BREADTH_FIRST else -1
        # Of two siblings the earlier is taken first in either order.
        for child in outcome.children if sign > 0 else reversed(outcome.children):
            number += 1
            heapq.heappush(state.frontier, (sign * (depth + 1), sign * number, depth + 1, child))
        yield state
