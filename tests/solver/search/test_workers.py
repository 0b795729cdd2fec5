"""A search shared by processes: the result is that of one process, whatever becomes of the others."""

import math
import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from holdfast.check_proof import check_proof
from holdfast.objects import Task
from holdfast.solver import Configuration, SolveResult, Verdict, solve
from holdfast.solver.contraction.prune import Box
from holdfast.solver.search import job_queue as job_queue_module
from holdfast.solver.search.branch_and_prune import SearchOrder, Subtree
from holdfast.solver.search.job_queue import JobQueue
from holdfast.solver.tasks.worker import TaskJobResult, TaskSetup, TaskWorker
from holdfast.workers import WorkerPool

DEADLINE_S = 60.0


def setup_of(task: Task, order: SearchOrder = SearchOrder.BREADTH_FIRST) -> TaskSetup:
    return TaskSetup(task, sigma=0.1, seed=0, pure=False, order=order)


def bits(configuration: Configuration) -> list[bytes]:
    state, proof = configuration.state, configuration.certificate
    assert proof is not None
    arrays = (state.q, state.R_palm_object, state.p_palm_object, state.params, proof.lower, proof.upper)
    return [*(a.tobytes() for a in arrays), repr((configuration.residual_m, proof.fixed)).encode()]


def summary(result: SolveResult) -> tuple[object, ...]:
    counts = (result.boxes, result.undecided, result.open, result.lps, result.abandoned)
    return result.verdict, counts, [bits(c) for c in result.configurations]


@pytest.fixture(scope="module")
def alone(upholding: Task) -> SolveResult:
    return solve(upholding, candidates=120, seed=3)


@pytest.mark.parametrize("workers", [2, pytest.param(3, marks=pytest.mark.slow)])
@pytest.mark.usefixtures("at_once")
def test_configurations_are_the_same_for_any_number_of_workers(
    upholding: Task, alone: SolveResult, workers: int
) -> None:
    shared = solve(upholding, candidates=120, seed=3, workers=workers, budget_s=math.inf)
    assert len(shared.configurations) == 120
    assert summary(shared) == summary(alone)
    assert all(c.task is upholding for c in shared.configurations)


@pytest.fixture(scope="module")
def thick(make_plate_task: Callable[[float], Task]) -> Task:
    return make_plate_task(0.106)


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize(
    "order",
    [
        SearchOrder.BEST_FIRST,
        *(pytest.param(o, marks=pytest.mark.slow) for o in SearchOrder if o is not SearchOrder.BEST_FIRST),
    ],
)
def test_a_refutation_is_the_same_for_any_number_of_workers(
    thick: Task, order: SearchOrder, tmp_path: Path
) -> None:
    logs = [tmp_path / "one.proof", tmp_path / "two.proof"]
    results = [
        solve(thick, order=order, workers=workers, proof=log, budget_s=math.inf)
        for workers, log in zip((1, 2), logs, strict=True)
    ]
    assert results[0].verdict is Verdict.INFEASIBLE
    assert results[0].boxes > 4
    assert summary(results[0]) == summary(results[1])
    assert logs[0].read_bytes() == logs[1].read_bytes(), "proofs are written in the order of the tree"
    assert check_proof(logs[1]).accepted


@pytest.fixture
def pool(upholding: Task) -> Iterator[WorkerPool]:
    pool = WorkerPool(setup_of(upholding), 2)
    assert pool.wait_until_complete(DEADLINE_S)
    yield pool
    pool.close()
    assert pool.pids == []


def slices(worker: TaskWorker, count: int) -> list[Subtree[Box]]:
    """Neighbouring boxes below the root."""
    boxes = [worker.root]
    while len(boxes) < count:
        part = worker.work(Subtree(boxes.pop(0), 0)).subtree
        boxes += [box for _, box in part.open]
    return [Subtree(box, 3, size=4) for box in boxes]


def same(a: TaskJobResult, b: TaskJobResult) -> bool:
    return (
        (a.subtree.processed, a.subtree.decided, a.lps, a.probes, a.landed)
        == (b.subtree.processed, b.subtree.decided, b.lps, b.probes, b.landed)
        and [bits(c) for c in a.subtree.solutions] == [bits(c) for c in b.subtree.solutions]
        and all(
            d == e
            and x.path == y.path
            and np.array_equal(x.lower, y.lower)
            and np.array_equal(x.upper, y.upper)
            for (d, x), (e, y) in zip(a.subtree.open, b.subtree.open, strict=True)
        )
    )


def test_a_killed_worker_costs_only_its_job(upholding: Task, pool: WorkerPool) -> None:
    here = TaskWorker(setup_of(upholding))
    work = slices(here, 24)
    futures = [pool.submit(one) for one in work]
    killed = 0
    for number, future in enumerate(futures):
        if number in (3, 8) and pool.pids:
            os.kill(pool.pids[0], signal.SIGKILL)
            killed += 1
        result = future.result(DEADLINE_S)
        assert result.abandoned == 0
        assert same(result, here.work(work[number]))
    assert killed == 2


def test_a_box_that_kills_every_worker_is_left_undecided(upholding: Task, pool: WorkerPool) -> None:
    worker = TaskWorker(setup_of(upholding))
    # What can't be read ends the process, as a crash of a library would.
    poison = Subtree(_Poison(worker.root.lower, worker.root.upper), 5)
    lost, fine = pool.submit(poison), [pool.submit(one) for one in slices(worker, 6)]
    result = lost.result(DEADLINE_S)
    assert result.abandoned == 1
    assert result.subtree.undecided == [poison.region]
    assert (result.subtree.processed, result.subtree.open, result.subtree.solutions) == (1, [], [])
    assert all(f.result(DEADLINE_S).abandoned == 0 for f in fine)


class _Poison(Box):
    """A box that ends any process in which it is unpacked."""

    def __reduce__(self) -> tuple[Callable[[int], None], tuple[int]]:
        return os._exit, (9,)


def test_an_error_in_a_worker_comes_back(upholding: Task, pool: WorkerPool) -> None:
    root = TaskWorker(setup_of(upholding)).root
    broken = Subtree(Box(root.lower, root.upper, path="neither 0 nor 1"), 0)
    with pytest.raises(ValueError, match="neither 0 nor 1"):
        pool.submit(broken).result(DEADLINE_S)


def test_the_search_works_itself_until_all_workers_are_up(
    upholding: Task, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(job_queue_module, "PATIENCE_S", 0.0)
    here = TaskWorker(setup_of(upholding))
    work = slices(here, 40)
    jobs = JobQueue(setup_of(upholding), here, workers=2)
    waits = [jobs.submit(one) for one in work]
    results = [wait() for wait in waits]
    jobs.close()
    assert all(same(result, here.work(one)) for result, one in zip(results, work, strict=True))


def test_a_short_search_starts_no_process(upholding: Task) -> None:
    worker = TaskWorker(setup_of(upholding))
    jobs = JobQueue(setup_of(upholding), worker, workers=2)
    wait = jobs.submit(Subtree(worker.root, 0))
    assert wait().subtree.processed == 1
    assert jobs.pool is None
