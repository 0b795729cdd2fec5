"""Branch and prune: the loop, which knows nothing of what is searched.

Subtrees are cut from the frontier, worked on, and merged in the order in which they were cut. Of a subtree at
most a given number of regions is processed; what is open then returns to the frontier. As many subtrees may
be under way at once as `lookahead` allows, here or in other processes: neither that number nor the order of
merging depends on how fast anything is, so the outcome doesn't either. A search is an iterator of its own
states, so that budgets, progress and "stop at the first" live with the caller.
"""

import heapq
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Generic, TypeVar

from ...arguments import check_instance

__all__ = [
    "Outcome",
    "SearchOrder",
    "SearchState",
    "Subtree",
    "SubtreeResult",
    "begin_at",
    "branch_and_prune",
    "check_order",
    "one_by_one",
    "search_subtree",
]

# Regions that are postponed come after all others, whatever the order: no other priority is above this.
_POSTPONED = 1e12

RegionT = TypeVar("RegionT")
SolutionT = TypeVar("SolutionT")
Key = Callable[[RegionT], float]


class SearchOrder(Enum):
    """Which region of the frontier comes next."""

    DEPTH_FIRST = "depth"
    BREADTH_FIRST = "breadth"
    BEST_FIRST = "best"


def check_order(order: SearchOrder) -> SearchOrder:
    """The order.

    Raises:
        InputError: it is none.
    """
    names = ", ".join(str(one) for one in SearchOrder)
    return check_instance("order", order, SearchOrder, f"one of {names}")


@dataclass(frozen=True)
class Outcome(Generic[RegionT, SolutionT]):
    """What became of a region.

    Attributes:
        solutions: what was found in it.
        children: regions that together hold every solution that it may still hold; the first is taken first.
        undecided: the region itself, where it may hold solutions but is too small to be split.
        postponed: what is left of the region, to be processed again after all others.
    """

    solutions: Sequence[SolutionT] = ()
    children: Sequence[RegionT] = ()
    undecided: RegionT | None = None
    postponed: RegionT | None = None


@dataclass(frozen=True)
class Subtree(Generic[RegionT]):
    """A region to be worked on, with what comes of it.

    Attributes:
        region: the root of the subtree.
        depth: how many splits it is below the root of the tree.
        size: how many regions of the subtree to process at most.
        context: a number by which the client tells what was known when the subtree was cut, so that the same
            work comes of it after a checkpoint.
    """

    region: RegionT
    depth: int
    size: int = 1
    context: int = 0


@dataclass
class SubtreeResult(Generic[RegionT, SolutionT]):
    """What became of a subtree.

    Attributes:
        processed: number of regions processed.
        solutions: everything found.
        undecided: regions that may hold solutions, but are too small to be split.
        decided: share of the subtree's root that is decided, in [0, 1]: 2^-depth for each leaf.
        open: (depth below the root, region) of what is still to be processed, the next one first.
    """

    processed: int = 0
    solutions: list[SolutionT] = field(default_factory=list)
    undecided: list[RegionT] = field(default_factory=list)
    decided: float = 0.0
    open: list[tuple[int, RegionT]] = field(default_factory=list)


Begin = Callable[[Subtree[RegionT]], Callable[[], SubtreeResult[RegionT, SolutionT]]]


@dataclass
class SearchState(Generic[RegionT, SolutionT]):
    """Where a search stands; the same object is updated from step to step.

    Attributes:
        order: which region comes next.
        key: what best first goes by: the smallest value first.
        n_roots: regions that the search began with.
        is_postponed: tells which regions come after all others, the least deep of them first.
        processed: number of regions processed.
        frontier: (priority, number, depth, region) of the regions still to be taken, as a heap.
        ahead: subtrees that were cut and are not merged yet, in their order.
        solutions: everything found.
        undecided: regions that may hold solutions, but are too small to be split.
        decided: share of the roots that is decided, in [0, 1]: 2^-depth for each leaf.
        depth: the deepest region that was taken.
        numbered: regions that ever came to the frontier.
    """

    order: SearchOrder = SearchOrder.DEPTH_FIRST
    key: Key[RegionT] | None = None
    n_roots: int = 1
    is_postponed: Callable[[RegionT], bool] | None = None
    processed: int = 0
    frontier: list[tuple[float, int, int, RegionT]] = field(default_factory=list)
    ahead: deque[Subtree[RegionT]] = field(default_factory=deque)
    solutions: list[SolutionT] = field(default_factory=list)
    undecided: list[RegionT] = field(default_factory=list)
    decided: float = 0.0
    depth: int = 0
    numbered: int = 0

    @property
    def n_open(self) -> int:
        """Regions that are still to be processed."""
        return len(self.frontier) + len(self.ahead)

    @property
    def only_postponed(self) -> bool:
        """Whether all that is in the frontier was postponed."""
        return not self.frontier or self.frontier[0][0] >= _POSTPONED

    @property
    def open_regions(self) -> list[RegionT]:
        """These regions, the next one first."""
        return [subtree.region for subtree in self.ahead] + [
            entry[-1] for entry in sorted(self.frontier, key=_place)
        ]

    def push(self, entries: Sequence[tuple[int, RegionT]]) -> None:
        """Adds (depth, region) to the frontier; of equal rank, the first is taken first."""
        last_in_first_out = self.order is SearchOrder.DEPTH_FIRST
        for depth, region in reversed(entries) if last_in_first_out else entries:
            self.numbered += 1
            number = -self.numbered if last_in_first_out else self.numbered
            heapq.heappush(self.frontier, (self._priority(depth, region), number, depth, region))

    def pop(self) -> tuple[int, RegionT]:
        """Takes the next (depth, region) from the frontier."""
        _, _, depth, region = heapq.heappop(self.frontier)
        self.depth = max(self.depth, depth)
        return depth, region

    def merge(self, result: SubtreeResult[RegionT, SolutionT], depth: int) -> None:
        """Adds what became of a subtree whose root lies at `depth`."""
        self.processed += result.processed
        self.solutions.extend(result.solutions)
        self.undecided.extend(result.undecided)
        self.decided += result.decided * 0.5**depth / self.n_roots
        self.push([(depth + below, region) for below, region in result.open])

    def _priority(self, depth: int, region: RegionT) -> float:
        if self.is_postponed is not None and self.is_postponed(region):
            return _POSTPONED + depth
        if self.order is SearchOrder.BEST_FIRST:
            assert self.key is not None, "best first needs a key"
            return min(self.key(region), 0.5 * _POSTPONED)
        return depth if self.order is SearchOrder.BREADTH_FIRST else -depth


def _place(entry: tuple[float, int, int, RegionT]) -> tuple[float, int]:
    return entry[0], entry[1]


def begin_at(
    roots: Sequence[RegionT],
    order: SearchOrder,
    key: Key[RegionT] | None = None,
    is_postponed: Callable[[RegionT], bool] | None = None,
) -> SearchState[RegionT, SolutionT]:
    """A state from which nothing has been taken yet."""
    state: SearchState[RegionT, SolutionT] = SearchState(order, key, len(roots), is_postponed)
    state.push([(0, root) for root in roots])
    return state


def branch_and_prune(
    state: SearchState[RegionT, SolutionT],
    begin: Begin[RegionT, SolutionT],
    *,
    cut: Callable[[RegionT, int], Subtree[RegionT]] = Subtree,
    lookahead: Callable[[], int] = lambda: 1,
) -> Iterator[SearchState[RegionT, SolutionT]]:
    """The loop: yields the state after each subtree until nothing is open.

    Args:
        state: where to begin; a state that was left can be gone on with.
        begin: hands a subtree over to be worked on; what it returns is called for the result in its turn. See
            `one_by_one`.
        cut: makes a subtree of a region that is taken and its depth; of the region alone unless given.
        lookahead: how many subtrees may be under way.
    """
    under_way = deque(begin(subtree) for subtree in state.ahead)
    while state.frontier or state.ahead:
        while state.frontier and len(state.ahead) < max(1, lookahead()):
            depth, region = state.pop()
            state.ahead.append(cut(region, depth))
            under_way.append(begin(state.ahead[-1]))
        result = under_way.popleft()()
        state.merge(result, state.ahead.popleft().depth)
        yield state


def one_by_one(process: Callable[[RegionT], Outcome[RegionT, SolutionT]]) -> Begin[RegionT, SolutionT]:
    """For `branch_and_prune`: processes the root of each subtree when its turn comes.

    Args:
        process: tells what becomes of a region.
    """

    def result(region: RegionT) -> SubtreeResult[RegionT, SolutionT]:
        outcome = process(region)
        left = [(1, child) for child in outcome.children]
        if outcome.postponed is not None:
            left.append((0, outcome.postponed))
        undecided = [] if outcome.undecided is None else [outcome.undecided]
        return SubtreeResult(
            processed=1,
            solutions=list(outcome.solutions),
            undecided=undecided,
            decided=0.0 if left else 1.0,
            open=left,
        )

    return lambda subtree: lambda: result(subtree.region)


def search_subtree(
    subtree: Subtree[RegionT],
    process: Callable[[RegionT], Outcome[RegionT, SolutionT]],
    order: SearchOrder,
    key: Key[RegionT] | None = None,
    is_postponed: Callable[[RegionT], bool] | None = None,
) -> SubtreeResult[RegionT, SolutionT]:
    """Processes the first regions of a subtree, by the same loop."""
    state: SearchState[RegionT, SolutionT] = begin_at([subtree.region], order, key, is_postponed)
    for _ in branch_and_prune(state, one_by_one(process)):
        if state.processed >= subtree.size:
            break
    return SubtreeResult(
        processed=state.processed,
        solutions=state.solutions,
        undecided=state.undecided,
        decided=state.decided,
        open=[(entry[2], entry[3]) for entry in sorted(state.frontier, key=_place)],
    )
