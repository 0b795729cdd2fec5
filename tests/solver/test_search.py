"""The loop on a toy domain: ranges of positions in a sorted list, searched for a number."""

import pytest
from holdfast.solver.search import Outcome, SearchOrder, branch_and_prune

NUMBERS = [k * k for k in range(64)]


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
    state = last_of(branch_and_prune([(0, 63)], finder(target, visited), order))
    assert [NUMBERS[k] for k in state.solutions] == [target]
    assert state.processed == len(visited) == 1 + 2 * 6
    assert state.frontier == [] and state.undecided == []
    assert state.decided == 1.0


@pytest.mark.parametrize("order", SearchOrder)
def test_a_number_that_is_not_there_is_not_found(order):
    state = last_of(branch_and_prune([(0, 63)], finder(10, []), order))
    assert state.solutions == [] and state.frontier == [] and state.decided == 1.0


def everything(visited: list[tuple[int, ...]], depth: int):
    def process(path: tuple[int, ...]) -> Outcome[tuple[int, ...], int]:
        visited.append(path)
        return Outcome() if len(path) == depth else Outcome(children=[(*path, 0), (*path, 1)])

    return process


def test_depth_first_goes_down_the_first_child_first():
    visited: list[tuple[int, ...]] = []
    last_of(branch_and_prune([()], everything(visited, 3), SearchOrder.DEPTH_FIRST))
    assert visited == sorted(visited)
    assert len(visited) == 15


def test_breadth_first_goes_level_by_level_and_keeps_the_order_of_siblings():
    visited: list[tuple[int, ...]] = []
    last_of(branch_and_prune([()], everything(visited, 3), SearchOrder.BREADTH_FIRST))
    assert visited == sorted(visited, key=lambda path: (len(path), path))
    assert len(visited) == 15


def test_each_state_counts_what_is_decided():
    shares = [s.decided for s in branch_and_prune([()], everything([], 2), SearchOrder.DEPTH_FIRST)]
    assert shares == [0.0, 0.0, 0.25, 0.5, 0.5, 0.75, 1.0]


def test_a_search_can_be_left_early_with_what_it_has():
    search = branch_and_prune([(0, 63)], finder(0, []), SearchOrder.DEPTH_FIRST)
    for state in search:
        if state.solutions:
            break
    assert state.solutions == [0]
    assert len(state.frontier) == 6
    assert state.decided == 2.0**-6


def test_solutions_and_remainders_of_one_region_are_all_kept():
    def process(k: int) -> Outcome[int, str]:
        return Outcome(["a", "b"], [1, 2]) if k == 0 else Outcome(undecided=k)

    state = last_of(branch_and_prune([0], process))
    assert state.solutions == ["a", "b"]
    assert state.undecided == [1, 2]
