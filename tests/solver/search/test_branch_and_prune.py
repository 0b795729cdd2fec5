"""The loop on a toy domain: ranges of positions in a sorted list, searched for a number."""

import pytest
from holdfast.solver.search.branch_and_prune import (
    Outcome,
    SearchOrder,
    Subtree,
    SubtreeResult,
    begin_at,
    branch_and_prune,
    one_by_one,
    search_subtree,
)

NUMBERS = [k * k for k in range(64)]


def whole_tree(roots, process, order=SearchOrder.DEPTH_FIRST, key=None):
    """A search one region after the other."""
    return branch_and_prune(begin_at(roots, order, key), one_by_one(process))


def finder(target: int, visited: list[tuple[int, int]]):
    def process(region: tuple[int, int]) -> Outcome[tuple[int, int], int]:
        visited.append(region)
        first, last = region
        if not NUMBERS[first] <= target <= NUMBERS[last]:
            return Outcome()
        if first == last:
            return Outcome([first])
        middle = (first + last) // 2
        return Outcome(children=[(first, middle), (middle + 1, last)])

    return process


def width(region: tuple[int, int]) -> float:
    return region[1] - region[0]


def last_of(states):
    state = None
    for state in states:  # noqa: B007
        pass
    assert state is not None
    return state


@pytest.mark.parametrize("order", SearchOrder)
@pytest.mark.parametrize("target", [0, 9, 961, 63 * 63])
def test_finds_the_number_in_either_order(order, target):
    visited: list[tuple[int, int]] = []
    state = last_of(whole_tree([(0, 63)], finder(target, visited), order, width))
    assert [NUMBERS[k] for k in state.solutions] == [target]
    assert state.processed == len(visited) == 1 + 2 * 6
    assert state.frontier == [] and state.undecided == []
    assert state.decided == 1.0


@pytest.mark.parametrize("order", SearchOrder)
def test_a_number_that_is_not_there_is_not_found(order):
    state = last_of(whole_tree([(0, 63)], finder(10, []), order, width))
    assert state.solutions == [] and state.frontier == [] and state.decided == 1.0


def everything(visited: list[tuple[int, ...]], depth: int):
    def process(path: tuple[int, ...]) -> Outcome[tuple[int, ...], int]:
        visited.append(path)
        return Outcome() if len(path) == depth else Outcome(children=[(*path, 0), (*path, 1)])

    return process


def test_depth_first_goes_down_the_first_child_first():
    visited: list[tuple[int, ...]] = []
    last_of(whole_tree([()], everything(visited, 3), SearchOrder.DEPTH_FIRST))
    assert visited == sorted(visited)
    assert len(visited) == 15


def test_breadth_first_goes_level_by_level_and_keeps_the_order_of_siblings():
    visited: list[tuple[int, ...]] = []
    last_of(whole_tree([()], everything(visited, 3), SearchOrder.BREADTH_FIRST))
    assert visited == sorted(visited, key=lambda path: (len(path), path))
    assert len(visited) == 15


def test_each_state_counts_what_is_decided():
    shares = [s.decided for s in whole_tree([()], everything([], 2), SearchOrder.DEPTH_FIRST)]
    assert shares == [0.0, 0.0, 0.25, 0.5, 0.5, 0.75, 1.0]


def test_a_search_can_be_left_early_with_what_it_has():
    search = whole_tree([(0, 63)], finder(0, []), SearchOrder.DEPTH_FIRST)
    for state in search:
        if state.solutions:
            break
    assert state.solutions == [0]
    assert len(state.frontier) == 6
    assert state.decided == 2.0**-6


def test_solutions_and_remainders_of_one_region_are_all_kept():
    def process(k: int) -> Outcome[int, str]:
        return Outcome(["a", "b"], [1, 2]) if k == 0 else Outcome(undecided=k)

    state = last_of(whole_tree([0], process))
    assert state.solutions == ["a", "b"]
    assert state.undecided == [1, 2]


def test_best_first_takes_the_smallest_key_and_the_older_of_equals():
    visited: list[tuple[int, ...]] = []
    key = {(): 0.0, (0,): 2.0, (1,): 1.0, (0, 0): 3.0, (0, 1): 3.0, (1, 0): 5.0, (1, 1): 0.5}
    last_of(whole_tree([()], everything(visited, 2), SearchOrder.BEST_FIRST, key.__getitem__))
    assert visited == [(), (1,), (1, 1), (0,), (0, 0), (0, 1), (1, 0)]


def test_the_deepest_region_is_known():
    states = whole_tree([()], everything([], 3), SearchOrder.DEPTH_FIRST)
    assert [s.depth for s in states][:5] == [0, 1, 2, 3, 3]


# Subtrees: several regions at a time, several subtrees under way


def tree_search(order, size, ahead, process, start=None):
    """A search in subtrees of `size` regions with `ahead` under way."""
    state = start or begin_at([(0, 63)], order, width)

    def begin(one: Subtree) -> object:
        return lambda: search_subtree(one, process, order, width)

    return branch_and_prune(
        state, begin, cut=lambda region, depth: Subtree(region, depth, size), lookahead=lambda: ahead
    )


def lister(low: int, high: int):
    """Finds all numbers in a range."""

    def process(region: tuple[int, int]) -> Outcome[tuple[int, int], int]:
        first, last = region
        if NUMBERS[last] < low or NUMBERS[first] > high:
            return Outcome()
        if first == last:
            return Outcome([first])
        middle = (first + last) // 2
        return Outcome(children=[(first, middle), (middle + 1, last)])

    return process


@pytest.mark.parametrize("order", SearchOrder)
@pytest.mark.parametrize(("size", "ahead"), [(1, 1), (1, 3), (4, 1), (3, 5), (100, 2)])
def test_subtrees_find_the_same_and_count_the_same(order, size, ahead):
    whole = last_of(whole_tree([(0, 63)], lister(50, 900), order, width))
    cut = last_of(tree_search(order, size, ahead, lister(50, 900)))
    assert sorted(cut.solutions) == sorted(whole.solutions) == list(range(8, 31))
    assert cut.processed == whole.processed
    assert cut.decided == whole.decided == 1.0
    assert cut.depth <= whole.depth  # of the roots of subtrees
    assert cut.n_open == 0


@pytest.mark.parametrize("size", [1, 2, 7])
def test_depth_first_in_subtrees_one_after_the_other_is_depth_first(size):
    whole = last_of(whole_tree([(0, 63)], lister(50, 900), SearchOrder.DEPTH_FIRST))
    cut = last_of(tree_search(SearchOrder.DEPTH_FIRST, size, 1, lister(50, 900)))
    assert cut.solutions == whole.solutions


def test_subtrees_are_merged_in_the_order_in_which_they_were_cut():
    """Whoever is fast: results that are there early wait for their turn."""
    begun: list[Subtree] = []
    asked: list[Subtree] = []

    def begin(one: Subtree) -> object:
        begun.append(one)

        def result() -> SubtreeResult:
            asked.append(one)
            return search_subtree(one, lister(50, 900), SearchOrder.BREADTH_FIRST)

        return result

    state = begin_at([(0, 63)], SearchOrder.BREADTH_FIRST)
    for now in branch_and_prune(state, begin, lookahead=lambda: 4):
        assert asked == begun[: len(asked)]
        assert list(now.ahead) == begun[len(asked) :]
        assert len(now.ahead) <= 3
    assert asked == begun


@pytest.mark.parametrize("order", SearchOrder)
def test_a_search_that_was_left_with_subtrees_under_way_can_be_gone_on_with(order):
    whole = last_of(tree_search(order, 3, 4, lister(50, 900)))
    steps = tree_search(order, 3, 4, lister(50, 900))
    for _, left in zip(range(3), steps, strict=False):
        state = left
    assert state.ahead
    again = last_of(tree_search(order, 3, 4, lister(50, 900), start=state))
    assert (again.solutions, again.processed) == (whole.solutions, whole.processed)


def test_open_regions_are_listed_in_the_order_in_which_they_come():
    steps = tree_search(SearchOrder.DEPTH_FIRST, 1, 1, lister(0, 4000))
    state = [state for _, state in zip(range(4), steps, strict=False)][-1]
    expected = state.open_regions
    assert [state.pop()[1] for _ in range(len(expected))] == expected


@pytest.mark.parametrize("order", SearchOrder)
@pytest.mark.parametrize("size", [1, 3, 100])
def test_what_is_postponed_comes_last_and_counts_when_it_is_decided(order, size):
    """Regions are (first, last, late); those that hold 20 are postponed once."""
    visited: list[tuple[int, int, bool]] = []

    def process(region: tuple[int, int, bool]) -> Outcome[tuple[int, int, bool], int]:
        first, last, late = region
        visited.append(region)
        if first == last:
            return Outcome([first])
        if not late and last - first <= 8 and first <= 20 <= last:
            return Outcome(postponed=(first, last, True))
        middle = (first + last) // 2
        return Outcome(children=[(first, middle, late), (middle + 1, last, late)])

    def is_postponed(region: tuple[int, int, bool]) -> bool:
        return region[2]

    def begin(one: Subtree) -> object:
        return lambda: search_subtree(one, process, order, width, is_postponed)

    state = begin_at([(0, 63, False)], order, width, is_postponed)
    for now in branch_and_prune(state, begin, cut=lambda region, depth: Subtree(region, depth, size)):
        if any(is_postponed(entry[3]) for entry in now.frontier) and now.only_postponed:
            assert now.decided == 1.0 - sum(0.5 ** entry[2] for entry in now.frontier)
    assert sorted(now.solutions) == list(range(64))
    assert now.decided == 1.0 and now.only_postponed
    postponed = [is_postponed(region) for region in visited]
    assert sum(postponed) == 15
    if size == 1:
        assert postponed == sorted(postponed)
