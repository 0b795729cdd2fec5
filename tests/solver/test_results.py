"""Results print as a line or two, are sequences of what was found, and name their joints."""

from collections.abc import Callable

import pytest
from holdfast.objects import Task
from holdfast.pipeline.records import to_solution
from holdfast.solver import (
    Progress,
    SolutionSet,
    SolveResult,
    SystemResult,
    iterate,
    solve,
    solve_all,
    solve_system,
)

CIRCLE = {((0, 2),): 1, ((1, 2),): 1, (): -1}
DIAGONAL = {((0, 1),): 1, ((1, 1),): -1}


@pytest.fixture(scope="module")
def result(upholding: Task) -> SolveResult:
    return solve(upholding, candidates=3)


@pytest.fixture(scope="module")
def infeasible(make_plate_task: Callable[[float], Task]) -> SolveResult:
    return solve(make_plate_task(0.106), candidates=1)


@pytest.fixture(scope="module")
def cover(upholding: Task) -> SolutionSet:
    return solve_all(upholding, budget_s=0.1)


@pytest.fixture(scope="module")
def system() -> SystemResult:
    return solve_system([CIRCLE, DIAGONAL], [-2, -2], [2, 2])


def test_results_say_in_a_line_how_it_ended(
    result: SolveResult, infeasible: SolveResult, cover: SolutionSet, system: SystemResult
) -> None:
    assert str(result).startswith(f"solved: 3 certified configurations, {result.boxes} boxes, ")
    assert str(infeasible).startswith(f"infeasible: 0 certified configurations, {infeasible.boxes} boxes, ")
    assert str(cover).startswith("undecided: a cover with 0 certified boxes, ")
    assert f"{cover.open} open" in str(cover)
    assert str(system).startswith(f"complete: 2 certified solutions, {system.boxes} boxes, ")
    one = solve_system([DIAGONAL, {((0, 1),): 1}], [-2, -2], [2, 2])
    assert str(one).startswith("complete: 1 certified solution, 1 box, ")
    curve = solve_system([CIRCLE], [-2, -2], [2, 2], sigma=0.5)
    assert str(curve).startswith(f"complete: a cover of {len(curve)} boxes, ")


def test_nothing_prints_its_arrays(result: SolveResult, cover: SolutionSet, system: SystemResult) -> None:
    task, configuration = result.task, result[0]
    things = [
        result, cover, system, configuration, configuration.certificate, cover.cover[0], system[0],
        result.progress, task, task.hand, task.object, *task.object.parts,
    ]  # fmt: skip
    for thing in things:
        for text in (str(thing), repr(thing)):
            assert len(text) < 200 and "array" not in text and "\n" not in text, type(thing)
            assert type(thing).__name__ in repr(thing)
    assert "certified" in str(configuration) and task.name in str(configuration)


def test_a_system_of_many_unknowns_is_cut_short() -> None:
    n = 40
    equations = [{((k, 1),): 2, (): -1} for k in range(n)]
    found = solve_system(equations, [0] * n, [1] * n)
    assert len(found) == 1 and len(str(found[0])) < 100


def test_html_holds_the_line_and_a_row_for_each_find(
    result: SolveResult, cover: SolutionSet, system: SystemResult
) -> None:
    for thing, name in ((result, "upholding: "), (cover, "upholding: "), (system, "")):
        html = thing._repr_html_()
        assert f"<p>{name}{thing}</p>" in html
        assert html.count("<tr>") == (1 + len(thing) if len(thing) else 0)
    html = result[0]._repr_html_()
    assert html.count("<tr>") == 1 + len(result[0].joints)


def test_a_result_is_a_sequence_of_what_was_found(
    result: SolveResult, infeasible: SolveResult, system: SystemResult
) -> None:
    assert result and not infeasible and system
    assert len(result) == 3 and len(infeasible) == 0
    assert tuple(result) == result.configurations and result[-1] is result.configurations[2]
    assert result[1:] == result.configurations[1:]
    assert tuple(system) == system.solutions and system[0] is system.solutions[0]
    with pytest.raises(IndexError):
        infeasible[0]


def test_joints_are_named_as_in_written_records(result: SolveResult) -> None:
    configuration = result[0]
    joints = configuration.joints
    assert joints == to_solution(configuration, "g01").joints
    assert tuple(joints) == result.task.hand.joint_names
    q = dict(zip(result.task.hand.independent_names, configuration.state.q, strict=True))
    assert {name: joints[name] for name in q} == pytest.approx(q, abs=1e-15)


def test_progress_counts_as_the_result_does(upholding: Task) -> None:
    search = next(iterate(upholding))
    progress: Progress = search.progress
    summed = SolveResult.of(search)
    assert (progress.boxes, progress.open, progress.found) == (summed.boxes, summed.open, len(summed))
    assert str(progress).startswith(f"{progress.found} found, 1 box done, {progress.open} open, ")
