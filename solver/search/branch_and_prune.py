"""Branch and prune: the loop, which knows nothing of what is searched.

Slices are cut from the frontier, worked on, and merged in the order in which they were cut. A slice is a
region with a number of regions of its subtree to process at most; what is left of it returns to the frontier.
As many slices may be under way at once as the plan says, here or in other processes: neither the plan nor the
order of merging depends on how fast anything is, so the outcome doesn't either. The search is an iterator of
its own states, so that budgets, progress and "stop at the first" live with the caller.
"""

import heapq
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Generic, TypeVar

__all__ = [
    "Outcome",
    "Part",
    "SearchOrder",
    "SearchState",
    "Slice",
    "begin_at",
    "branch_and_prune",
    "explore",
    "search",
]

# Regions that are put off come after all others, whatever the order: no other priority is above this.
_LATE = 1e12

RegionT = TypeVar("RegionT")
SolutionT = TypeVar("SolutionT")
Key = Callable[[RegionT], float]


class SearchOrder(Enum):
    """Which region of the frontier comes next."""

    DEPTH_FIRST = "depth"
    BREADTH_FIRST = "breadth"
    BEST_FIRST = "best"


@dataclass(frozen=True)
class Outcome(Generic[RegionT, SolutionT]):
    """What became of a region.

    Attributes:
        solutions: what was found in it.
        children: regions that together hold every solution that it may still hold; the first is taken first.
        undecided: the region itself, where it may hold solutions but is too small to be split.
        postponed: what is left of the region, to be processed again in its turn.
    """

    solutions: Sequence[SolutionT] = ()
    children: Sequence[RegionT] = ()
    undecided: RegionT | None = None
    postponed: RegionT | None = None


@dataclass(frozen=True)
class Slice(Generic[RegionT]):
    """A region to be worked on.

    Attributes:
        region: the root of the subtree.
        depth: how many splits it is below the root of the tree.
        size: how many regions of the subtree to process at most.
        effort: for whoever works on it.
    """

    region: RegionT
    depth: int
    size: int = 1
    effort: int = 0


@dataclass
class Part(Generic[RegionT, SolutionT]):
    """What became of a slice, or of several.

    Attributes:
        processed: number of regions processed.
        solutions: everything found.
        undecided: regions left over.
        decided: share of the slice's region that is decided, in [0, 1]: 2^-depth for each leaf.
        left: (depth below the slice, region) of what is still to be processed, the next one first.
    """

    processed: int = 0
    solutions: list[SolutionT] = field(default_factory=list)
    undecided: list[RegionT] = field(default_factory=list)
    decided: float = 0.0
    left: list[tuple[int, RegionT]] = field(default_factory=list)


@dataclass
class SearchState(Generic[RegionT, SolutionT]):
    """Where a search stands; the same object is updated from step to step.

    Attributes:
        order: which region comes next.
        key: what best first goes by: the smallest value first.
        n_roots: regions that the search began with.
        is_late: tells which regions come after all others, the least deep of them first.
        processed: number of regions processed.
        frontier: (priority, number, depth, region) of the regions still to be taken, as a heap.
        ahead: slices that were taken and are not merged yet, in their order.
        solutions: everything found.
        undecided: regions left over.
        decided: share of the roots that is decided, in [0, 1]: 2^-depth for each leaf.
        depth: the deepest region that was taken.
        numbered: regions that ever came to the frontier.
    """

    order: SearchOrder = SearchOrder.DEPTH_FIRST
    key: Key[RegionT] | None = None
    n_roots: int = 1
    is_late: Callable[[RegionT], bool] | None = None
    processed: int = 0
    frontier: list[tuple[float, int, int, RegionT]] = field(default_factory=list)
    ahead: deque[Slice[RegionT]] = field(default_factory=deque)
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
    def is_late_next(self) -> bool:
        """Whether all that is in the frontier was put off."""
        return not self.frontier or self.frontier[0][0] >= _LATE

    @property
    def open_regions(self) -> list[RegionT]:
        """These regions, the next one first."""
        return [s.region for s in self.ahead] + [entry[-1] for entry in sorted(self.frontier, key=_place)]

    def push(self, left: Sequence[tuple[int, RegionT]]) -> None:
        """Adds (depth, region) to the frontier; of equal rank, the first is taken first."""
        last_in_first_out = self.order is SearchOrder.DEPTH_FIRST
        for depth, region in reversed(left) if last_in_first_out else left:
            self.numbered += 1
            number = -self.numbered if last_in_first_out else self.numbered
            heapq.heappush(self.frontier, (self._priority(depth, region), number, depth, region))

    def pop(self) -> tuple[int, RegionT]:
        """Takes the next (depth, region) from the frontier."""
        _, _, depth, region = heapq.heappop(self.frontier)
        self.depth = max(self.depth, depth)
        return depth, region

    def merge(self, part: Part[RegionT, SolutionT], depth: int) -> None:
        """Adds what became of a slice that began at `depth`."""
        self.processed += part.processed
        self.solutions.extend(part.solutions)
        self.undecided.extend(part.undecided)
        self.decided += part.decided * 0.5**depth / self.n_roots
        self.push([(depth + below, region) for below, region in part.left])

    def _priority(self, depth: int, region: RegionT) -> float:
        if self.is_late is not None and self.is_late(region):
            return _LATE + depth
        if self.order is SearchOrder.BEST_FIRST:
            assert self.key is not None, "best first needs a key"
            return min(self.key(region), 0.5 * _LATE)
        return depth if self.order is SearchOrder.BREADTH_FIRST else -depth


def _place(entry: tuple[float, int, int, RegionT]) -> tuple[float, int]:
    return entry[0], entry[1]


def begin_at(
    roots: Sequence[RegionT],
    order: SearchOrder,
    key: Key[RegionT] | None = None,
    is_late: Callable[[RegionT], bool] | None = None,
) -> SearchState[RegionT, SolutionT]:
    """A state from which nothing has been taken yet."""
    state: SearchState[RegionT, SolutionT] = SearchState(order, key, len(roots), is_late)
    state.push([(0, root) for root in roots])
    return state


def search(
    state: SearchState[RegionT, SolutionT],
    cut: Callable[[int, RegionT], Slice[RegionT]],
    begin: Callable[[Slice[RegionT]], Callable[[], Part[RegionT, SolutionT]]],
    lookahead: Callable[[], int] = lambda: 1,
) -> Iterator[SearchState[RegionT, SolutionT]]:
    """Yields the state after each slice until the frontier is empty.

    Args:
        state: where to begin; a state that was left can be gone on with.
        cut: makes a slice of a (depth, region) that is taken.
        begin: hands a slice over to be worked on; what it returns is called for the result in its turn.
        lookahead: how many slices may be under way.
    """
    under_way = deque(begin(one) for one in state.ahead)
    while state.frontier or state.ahead:
        while state.frontier and len(state.ahead) < max(1, lookahead()):
            state.ahead.append(cut(*state.pop()))
            under_way.append(begin(state.ahead[-1]))
        part = under_way.popleft()()
        state.merge(part, state.ahead.popleft().depth)
        yield state


def explore(
    one: Slice[RegionT],
    process: Callable[[RegionT], Outcome[RegionT, SolutionT]],
    order: SearchOrder,
    key: Key[RegionT] | None = None,
    is_late: Callable[[RegionT], bool] | None = None,
) -> Part[RegionT, SolutionT]:
    """Works on a slice: processes the first regions of its subtree."""
    state: SearchState[RegionT, SolutionT] = begin_at([one.region], order, key, is_late)
    while state.frontier and state.processed < one.size:
        depth, region = state.pop()
        outcome = process(region)
        left = [(1, child) for child in outcome.children]
        if outcome.postponed is not None:
            left.append((0, outcome.postponed))
        undecided = [] if outcome.undecided is None else [outcome.undecided]
        state.merge(Part(1, list(outcome.solutions), undecided, 0.0 if left else 1.0, left), depth)
    left = [(entry[2], entry[3]) for entry in sorted(state.frontier, key=_place)]
    return Part(state.processed, state.solutions, state.undecided, state.decided, left)


def branch_and_prune(
    roots: Sequence[RegionT],
    process: Callable[[RegionT], Outcome[RegionT, SolutionT]],
    order: SearchOrder = SearchOrder.DEPTH_FIRST,
    key: Key[RegionT] | None = None,
) -> Iterator[SearchState[RegionT, SolutionT]]:
    """Processes regions one by one; yields the state after each until the frontier is empty.

    Args:
        roots: regions that together hold all solutions.
        process: says what became of a region.
        order: which region comes next.
        key: what best first goes by: the region with the smallest value comes first.
    """

    def begin(one: Slice[RegionT]) -> Callable[[], Part[RegionT, SolutionT]]:
        return lambda: explore(one, process, order, key)

    state: SearchState[RegionT, SolutionT] = begin_at(roots, order, key)
    yield from search(state, lambda depth, region: Slice(region, depth), begin)
