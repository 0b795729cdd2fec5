"""Searches of polynomial systems end with the same in any order and number of processes, left or killed."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.solver import SearchOrder, SystemResult, SystemSearch, Verdict, iterate_system, solve_system
from holdfast.solver.search.branch_and_prune import Subtree
from holdfast.solver.systems.file import SystemProblem, system_from_data
from holdfast.solver.systems.found import CaseSolution
from holdfast.solver.systems.parts import equation_parts
from holdfast.solver.systems.worker import SystemBox, SystemJob, SystemJobResult, SystemSetup, SystemWorker
from holdfast.workers import WorkerPool

DEADLINE_S = 120.0

# Points, in the same region or not; a curve that is covered; a double root beside simple ones; a curve where
# points are expected, on which splitting has no end; nothing.
SYSTEMS: dict[str, tuple[dict[str, list[float]], list[str]]] = {
    "points": (
        {v: [-4, 4] for v in "abcd"},
        [f"{p}*({q}**2 + {r}**2 + {s}**2) - 1.1*{p} + 1" for p, q, r, s in ("abcd", "bcda", "cdab", "dabc")],
    ),
    "curve": ({"x": [-2, 2], "y": [-2, 2]}, ["x**2 + y**2 - 1"]),
    "double": ({"x": [-3, 3], "y": [-3, 3]}, ["x**3 - 3*x**2 + y**2 - 1", "y**4 - x**4 - 2*x**2 - 1"]),
    "endless": ({"x": [-1, 1], "y": [-1, 1], "z": [2, 2]}, ["x*y", "x*(z*y - 1)"]),
    "none": ({v: [-3, 3] for v in "xyz"}, ["x**2 + y**2 + z**2 - 1", "x*y + z - 1.3", "x - y*z - 0.2"]),
}
COUNTS = {"points": 15, "double": 2, "endless": 0, "none": 0}


def problem_of(name: str) -> SystemProblem:
    variables, equations = SYSTEMS[name]
    return system_from_data({"variables": variables, "equations": equations}, name)


def run(name: str, **options: Any) -> SystemResult:
    problem = problem_of(name)
    return solve_system(problem.equations, problem.lower, problem.upper, **options)


def steps_of(name: str, **options: Any) -> Iterator[SystemSearch]:
    problem = problem_of(name)
    return iterate_system(problem.equations, problem.lower, problem.upper, **options)


def leave_after(name: str, count: int, **options: Any) -> SystemSearch:
    """Takes so many steps and leaves the search."""
    steps = steps_of(name, **options)
    *_, search = islice(steps, count)
    steps.close()  # type: ignore[attr-defined]
    return search


def bits(result: SystemResult) -> tuple[object, ...]:
    counts = (result.verdict, result.boxes, result.decided, result.covers, result.abandoned)
    found = [(s.lower.tobytes(), s.upper.tobytes(), s.certified) for s in result.solutions]
    return counts, found, [(low.tobytes(), high.tobytes()) for low, high in result.remaining]


@pytest.fixture(scope="module")
def whole() -> dict[str, SystemResult]:
    return {name: run(name) for name in SYSTEMS}


def circle(count: int) -> np.ndarray:
    """Points (count, 2) of the curve of the system of that name."""
    angles = np.linspace(0, 2 * np.pi, count)
    return np.column_stack([np.cos(angles), np.sin(angles)])


def assert_holds_the_circle(result: SystemResult) -> None:
    assert result.remaining == () and result.solutions
    low, high = (np.array([getattr(s, end) for s in result.solutions])[:, None] for end in ("lower", "upper"))
    points = circle(500)
    assert np.all(np.any(np.all((low - 1e-12 <= points) & (points <= high + 1e-12), axis=2), axis=0))


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("order", [SearchOrder.BREADTH_FIRST, SearchOrder.BEST_FIRST])
def test_any_order_finds_the_same_solutions(
    name: str, order: SearchOrder, whole: dict[str, SystemResult]
) -> None:
    result, usual = run(name, order=order), whole[name]
    assert (result.verdict, result.covers) == (usual.verdict, usual.covers)
    assert result.covers is (name == "curve")
    if result.covers:  # covers differ, but each holds the whole curve
        assert_holds_the_circle(result)
        return
    assert len(result.solutions) == len(usual.solutions) == COUNTS[name]
    for s in result.solutions:
        same = [t for t in usual.solutions if np.all(np.abs(s.middle - t.middle) <= s.radius + t.radius)]
        assert len(same) == 1


@pytest.mark.parametrize("name", SYSTEMS)
def test_all_is_decided_in_the_end_unless_that_has_no_end(name: str) -> None:
    shares = []
    for search in steps_of(name):
        progress = search.progress
        shares.append(progress.decided)
        assert progress.boxes >= progress.depth
        assert 0.0 <= progress.seconds <= search.seconds
    assert shares and shares == sorted(shares)
    result = SystemResult.of(search)
    assert progress.open + progress.undecided == len(result.remaining)
    assert progress.found == len(result.solutions)
    if name == "endless":
        assert shares[-1] < 1.0 and progress.open > 0
        assert result.verdict is Verdict.UNDECIDED
    else:
        assert shares[-1] == result.decided == 1.0 and progress.open == 0


@pytest.mark.parametrize("name", ["points", "curve", "double"])
def test_at_any_moment_all_solutions_lie_in_the_boxes_at_hand(
    name: str, whole: dict[str, SystemResult]
) -> None:
    if name == "curve":
        points = circle(40)
    else:
        points = np.array([s.middle for s in whole[name].solutions])
        assert len(points) == COUNTS[name]
    moments = 0
    for search in steps_of(name, order=SearchOrder.BEST_FIRST):
        now = SystemResult.of(search)
        boxes = [*now.remaining, *((s.lower, s.upper) for s in now.solutions)]
        low, high = (np.array(ends)[:, None] for ends in zip(*boxes, strict=True))
        inside = np.all((low - 1e-12 <= points) & (points <= high + 1e-12), axis=2)
        assert np.all(np.any(inside, axis=0))
        moments += 1
    assert moments > 3


def test_best_first_finds_a_solution_no_later_than_the_usual_order() -> None:
    def boxes_to_the_first(order: SearchOrder) -> int:
        return next(s.state.processed for s in steps_of("points", order=order) if s.state.solutions)

    assert boxes_to_the_first(SearchOrder.BEST_FIRST) <= boxes_to_the_first(SearchOrder.BREADTH_FIRST)


def test_a_budget_ends_the_search_after_the_step_at_which_it_is_spent() -> None:
    assert run("points", budget_s=1e-9).boxes == 1


# Checkpoints


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("steps", [1, 3, 7, 40])
def test_a_search_that_was_left_goes_on_to_the_same_result(
    name: str, steps: int, whole: dict[str, SystemResult], tmp_path: Path
) -> None:
    path = tmp_path / "search.checkpoint"
    left = leave_after(name, steps, checkpoint=path)
    assert left.state.processed <= whole[name].boxes
    # Again, in the middle of things; and once more, to the end.
    leave_after(name, 2, checkpoint=path, resume=True) if left.state.n_open and name != "endless" else None
    resumed = run(name, checkpoint=path, resume=True)
    assert bits(resumed) == bits(whole[name])
    # What is known already is not looked for again.
    assert bits(run(name, checkpoint=path, resume=True)) == bits(whole[name])


@pytest.mark.parametrize("order", [SearchOrder.BREADTH_FIRST, SearchOrder.BEST_FIRST])
def test_other_orders_go_on_to_the_same_result(order: SearchOrder, tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    leave_after("points", 20, order=order, checkpoint=path)
    resumed = run("points", order=order, checkpoint=path, resume=True)
    assert bits(resumed) == bits(run("points", order=order))


def test_a_budget_counts_anew_for_a_search_that_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    processed = [
        run("points", budget_s=1e-9, checkpoint=path, resume=resume).boxes for resume in (False, True, True)
    ]
    assert processed == [1, 2, 3]


SCRIPT = """
import sys
from holdfast.solver import iterate_system
from holdfast.solver.polynomial import parse_polynomial
names = tuple(f"x{i}" for i in range(8))
texts = [f"x{i}**3 - 2*x{(i + 1) % 8}*x{i} + 0.3" for i in range(7)]
equations = [parse_polynomial(t, names, "test", "") for t in texts]
resume, workers, size = sys.argv[2] == "resume", int(sys.argv[3]), int(sys.argv[4])
options = {"sigma": 1e-3, "checkpoint": sys.argv[1], "resume": resume, "workers": workers}
for search in iterate_system(equations, [-5.0] * 8, [5.0] * 8, **options):
    if search.state.processed >= size:
        break
state = search.state
print(state.processed, state.decided, sum(float(b.lower.sum()) for b in state.undecided + state.open_regions))
"""


@pytest.mark.slow
@pytest.mark.parametrize("workers", ["1", "2"])
def test_a_search_that_is_killed_goes_on_from_its_last_checkpoint(tmp_path: Path, workers: str) -> None:
    killed, alone = tmp_path / "killed.checkpoint", tmp_path / "alone.checkpoint"
    process = subprocess.Popen([sys.executable, "-c", SCRIPT, str(killed), "begin", workers, "1000000"])
    first = wait_for(killed.exists) and killed.stat().st_mtime_ns
    wait_for(lambda: killed.stat().st_mtime_ns > first)
    second = killed.stat().st_mtime_ns
    wait_for(lambda: killed.stat().st_mtime_ns > second)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    outputs = []
    size = "1"
    for path in (killed, killed, alone):
        words = [sys.executable, "-c", SCRIPT, str(path), "resume", "1", size]
        outputs.append(subprocess.check_output(words, text=True).split())
        size = str(int(outputs[0][0]) + 200)
    assert int(outputs[0][0]) > 1
    assert outputs[1] == outputs[2]


def wait_for(condition: Callable[[], bool]) -> bool:
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)
    return True


@pytest.mark.parametrize(
    "change",
    [{"sigma": 1e-5}, {"order": SearchOrder.BEST_FIRST}, {"name": "double"}, {"box": -3.5}],
    ids=["sigma", "order", "system", "box"],
)
def test_a_checkpoint_of_another_search_is_refused(change: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    leave_after("points", 2, checkpoint=path)
    before = path.read_bytes()
    problem = problem_of(change.pop("name", "points"))
    lower = (Fraction(change.pop("box", float(problem.lower[0]))), *problem.lower[1:])
    with pytest.raises(InputError, match=r"search\.checkpoint: is the checkpoint of another system, other"):
        solve_system(problem.equations, lower, problem.upper, checkpoint=path, resume=True, **change)
    assert path.read_bytes() == before


def test_a_checkpoint_is_not_written_over_by_a_new_search(tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    run("double", checkpoint=path)
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"search\.checkpoint: exists; resume it"):
        run("double", checkpoint=path)
    assert path.read_bytes() == before


def test_a_damaged_checkpoint_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    run("points", checkpoint=path)
    data = path.read_bytes()
    places = np.random.default_rng(0).integers(len(data), size=20)
    damaged = [data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :] for place in places]
    for other in [b"", b"{}", data[:-1], data[: len(data) // 2], data + b"x", *damaged]:
        path.write_bytes(other)
        with pytest.raises(InputError, match=r"search\.checkpoint: is no checkpoint"):
            run("points", checkpoint=path, resume=True)


# Processes


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize(
    "name", ["points", *(pytest.param(name, marks=pytest.mark.slow) for name in ("curve", "endless"))]
)
def test_the_result_is_the_same_for_two_workers(name: str, whole: dict[str, SystemResult]) -> None:
    assert bits(run(name, workers=2)) == bits(whole[name])


@pytest.mark.usefixtures("at_once")
def test_a_search_that_was_left_by_two_workers_is_gone_on_with_by_one(
    whole: dict[str, SystemResult], tmp_path: Path
) -> None:
    path = tmp_path / "search.checkpoint"
    left = leave_after("points", 40, checkpoint=path, workers=2)
    assert left.state.ahead, "slices are under way when it is left"
    assert bits(run("points", checkpoint=path, resume=True)) == bits(whole["points"])


def same(a: SystemJobResult, b: SystemJobResult) -> bool:
    def flat(found: Any) -> list[bytes]:
        boxes = (
            (found.solution.region, found.solution.place)
            if isinstance(found, CaseSolution)
            else ((found.lower, found.upper),)
        )
        return [end.tobytes() for box in boxes for end in box]

    def summary(outcome: SystemJobResult) -> tuple[object, ...]:
        part = outcome.subtree
        left = [(depth, flat(box), box.postponed) for depth, box in part.open]
        found = [flat(one) for one in part.solutions]
        return part.processed, part.decided, left, found, [flat(box) for box in part.undecided]

    return summary(a) == summary(b)


def slices(worker: SystemWorker, count: int) -> list[SystemJob]:
    """Neighbouring boxes below the root, each without and with what was found in it."""
    boxes = [worker.root]
    while len(boxes) < count:
        boxes += [box for _, box in worker.work(SystemJob(Subtree(boxes.pop(0), 0), [])).subtree.open]
    jobs = [SystemJob(Subtree(box, 3, size=16), []) for box in boxes]
    finds = [[f for f in worker.work(job).subtree.solutions if isinstance(f, CaseSolution)] for job in jobs]
    return jobs + [SystemJob(job.subtree, known) for job, known in zip(jobs, finds, strict=True) if known]


def points_setup() -> tuple[SystemProblem, SystemSetup]:
    problem = problem_of("points")
    ends = list(zip(problem.lower, problem.upper, strict=True))
    parts = tuple(equation_parts(problem.equations, ends, {}))
    return problem, SystemSetup(parts, ends, 1e-7, SearchOrder.DEPTH_FIRST)


@pytest.mark.slow
def test_a_killed_worker_costs_only_its_job() -> None:
    problem = problem_of("points")
    ends = list(zip(problem.lower, problem.upper, strict=True))
    setup = SystemSetup(
        tuple(equation_parts(problem.equations, ends, {})), ends, 1e-7, SearchOrder.DEPTH_FIRST
    )
    here = SystemWorker(setup)
    jobs = slices(here, 5)
    pool: WorkerPool[SystemJob, SystemJobResult] = WorkerPool(setup, 2)
    assert pool.wait_until_complete(DEADLINE_S)
    poison = SystemJob(Subtree(_Poison(*problem_box(problem), here.root.choice), 5), [])
    lost = pool.submit(poison)
    futures = [pool.submit(job) for job in jobs]
    for number, (future, job) in enumerate(zip(futures, jobs, strict=True)):
        if number == 4 and pool.pids:
            os.kill(pool.pids[0], signal.SIGKILL)
        result = future.result(DEADLINE_S)
        assert result.abandoned == 0
        assert same(result, here.work(job))
    given_up = lost.result(DEADLINE_S)
    pool.close()
    assert given_up.abandoned == 1 and given_up.subtree.undecided == [poison.subtree.region]
    assert pool.pids == []


def problem_box(problem: SystemProblem) -> tuple[np.ndarray, np.ndarray]:
    return np.array(problem.lower, dtype=float), np.array(problem.upper, dtype=float)


class _Poison(SystemBox):
    """A box that ends any process in which it is unpacked, as a crash of a library would."""

    def __reduce__(self) -> tuple[Callable[[int], None], tuple[int]]:
        return os._exit, (9,)


def test_a_subtree_finds_nothing_twice_and_nothing_that_is_known() -> None:
    problem = problem_of("points")
    ends = list(zip(problem.lower, problem.upper, strict=True))
    worker = SystemWorker(
        SystemSetup(tuple(equation_parts(problem.equations, ends, {})), ends, 1e-7, SearchOrder.DEPTH_FIRST)
    )
    root = Subtree(worker.root, 0, size=1000)
    found = [f for f in worker.work(SystemJob(root, [])).subtree.solutions if isinstance(f, CaseSolution)]
    assert len(found) == COUNTS["points"]
    again = worker.work(SystemJob(root, found[:6])).subtree.solutions
    assert len(again) == COUNTS["points"] - 6
    assert worker.work(SystemJob(root, found)).subtree.solutions == []
