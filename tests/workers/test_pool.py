"""The pool does every job once, whatever becomes of its processes, and leaves none behind."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import CancelledError
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.workers import WorkerPool
from holdfast.workers.forked import can_fork

# Processes are given the same path, and find the setup there.
sys.path.insert(0, str(Path(__file__).parent))

from toy_setup import Job, Large, Setup

DEADLINE_S = 60.0


@pytest.fixture
def setup() -> Setup:
    return Setup(factor=3)


@pytest.fixture(params=["copies", "fresh"])
def start(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How processes of a pool begin; copies where this process has one thread, as it may have here."""
    if request.param == "fresh":
        monkeypatch.setattr("holdfast.workers.pool.can_fork", lambda: False)
    elif not can_fork():
        pytest.skip("this process has several threads")
    return str(request.param)


@pytest.fixture
def pool(setup: Setup, start: str) -> Iterator[WorkerPool[Job, object]]:
    with WorkerPool(setup, 2) as pool:
        assert pool.wait_until_complete(DEADLINE_S)
        assert pool.ready and pool.complete
        yield pool
    assert pool.pids == []


def test_jobs_are_done_and_answered_in_their_own_futures(pool: WorkerPool[Job, object]) -> None:
    futures = [pool.submit(Job("multiply", k)) for k in range(50)]
    assert [future.result(DEADLINE_S) for future in futures] == [3 * k for k in range(50)]


def test_all_processes_share_the_work(pool: WorkerPool[Job, object]) -> None:
    pids = {pool.submit(Job("pid")) for _ in range(8)}
    assert {future.result(DEADLINE_S) for future in pids} == set(pool.pids)
    assert os.getpid() not in pool.pids


def test_jobs_may_be_handed_in_before_any_process_is_up(setup: Setup) -> None:
    with WorkerPool(setup, 2) as pool:
        futures = [pool.submit(Job("multiply", k)) for k in range(5)]
        assert [future.result(DEADLINE_S) for future in futures] == [0, 3, 6, 9, 12]


@pytest.mark.parametrize("count", [1, 3])
def test_a_caller_that_is_busy_gets_all_its_processes_too(setup: Setup, count: int) -> None:
    with WorkerPool(setup, count, caller_is_busy=True) as pool:
        assert pool.wait_until_complete(DEADLINE_S)
        assert len(pool.pids) == count


def test_a_killed_process_costs_its_job_one_more_attempt(pool: WorkerPool[Job, object]) -> None:
    before = set(pool.pids)
    sleeping = [pool.submit(Job("sleep", 1)) for _ in range(2)]
    time.sleep(0.3)
    killed = pool.pids[0]
    os.kill(killed, signal.SIGKILL)
    assert [future.result(DEADLINE_S) for future in sleeping] == [None, None]
    after = set(pool.pids)
    assert len(after) == 2 and len(after & before) == 1 and killed not in after


def test_a_process_that_is_killed_while_it_is_free_costs_nothing(pool: WorkerPool[Job, object]) -> None:
    for pid in pool.pids:
        os.kill(pid, signal.SIGKILL)
    futures = [pool.submit(Job("multiply", k)) for k in range(6)]
    assert [future.result(DEADLINE_S) for future in futures] == [0, 3, 6, 9, 12, 15]


def test_a_job_that_ends_every_process_is_given_up_alone(pool: WorkerPool[Job, object]) -> None:
    deadly, others = pool.submit(Job("die", 8)), [pool.submit(Job("multiply", k)) for k in range(10)]
    assert deadly.result(DEADLINE_S) == ("given up", 8)
    assert [future.result(DEADLINE_S) for future in others] == [3 * k for k in range(10)]


def test_errors_come_back_with_their_facts_and_where_they_were_raised(
    pool: WorkerPool[Job, object],
) -> None:
    with pytest.raises(InputError, match="a file: a field: what is allowed") as caught:
        pool.submit(Job("raise", 0)).result(DEADLINE_S)
    assert (caught.value.source, caught.value.field) == ("a file", "a field")
    assert "toy_setup.py" in caught.value.__notes__[0]
    with pytest.raises(FileNotFoundError, match="no such thing"):  # the worker's, not one of the pipe
        pool.submit(Job("raise", 1)).result(DEADLINE_S)
    with pytest.raises(RuntimeError, match="Unsendable: this can't be sent"):
        pool.submit(Job("raise", 2)).result(DEADLINE_S)
    assert pool.submit(Job("multiply", 5)).result(DEADLINE_S) == 15


def test_answers_that_are_errors_are_answers(pool: WorkerPool[Job, object]) -> None:
    assert isinstance(pool.submit(Job("answer with an error")).result(DEADLINE_S), KeyError)


def test_what_cannot_be_pickled_is_told(pool: WorkerPool[Job, object]) -> None:
    with pytest.raises((TypeError, AttributeError), match="pickle"):
        pool.submit(Job("multiply", (lambda: 0))).result(DEADLINE_S)  # type: ignore[arg-type]
    with pytest.raises(Exception, match="pickle"):
        pool.submit(Job("answer with what can't be sent")).result(DEADLINE_S)
    with pytest.raises((TypeError, AttributeError), match="pickle"):
        WorkerPool(Setup(fails=lambda: ""), 1)  # type: ignore[arg-type]


def test_what_is_shared_stays_the_same_object_at_both_ends(
    setup: Setup, pool: WorkerPool[Job, object]
) -> None:
    assert pool.submit(Job("is yours", large=setup.large)).result(DEADLINE_S) is True
    assert pool.submit(Job("is yours", large=Large())).result(DEADLINE_S) is False
    number, large = pool.submit(Job("give back", 4)).result(DEADLINE_S)  # type: ignore[misc]
    assert number == 4 and large is setup.large


def test_what_a_worker_prints_is_no_answer(pool: WorkerPool[Job, object]) -> None:
    assert pool.submit(Job("print")).result(DEADLINE_S) is None


def test_a_setup_that_raises_tells_every_job(setup: Setup) -> None:
    with WorkerPool(Setup(fails="raises"), 2) as pool:
        for future in [pool.submit(Job("multiply", k)) for k in range(3)]:
            with pytest.raises(InputError, match="the toy: field: must not fail"):
                future.result(DEADLINE_S)
        assert not pool.ready and not pool.complete


def test_a_setup_that_ends_its_process_gives_every_job_up() -> None:
    with WorkerPool(Setup(fails="dies"), 2, caller_is_busy=True) as pool:
        futures = [pool.submit(Job("multiply", k)) for k in range(2)]
        assert [future.result(DEADLINE_S) for future in futures] == [("given up", 0), ("given up", 1)]


def test_closing_cancels_what_is_not_done(setup: Setup) -> None:
    pool: WorkerPool[Job, object] = WorkerPool(setup, 2)
    assert pool.wait_until_complete(DEADLINE_S)
    futures = [pool.submit(Job("sleep", 600)) for _ in range(5)]
    time.sleep(0.2)
    began = time.perf_counter()
    pool.close()
    assert time.perf_counter() - began < 30.0
    assert pool.pids == []
    for future in futures:
        with pytest.raises(CancelledError):
            future.result(DEADLINE_S)
    pool.close()
    with pytest.raises(RuntimeError):
        pool.submit(Job("multiply"))


@pytest.mark.parametrize("after_s", [0.0, 0.02, 0.1])
@pytest.mark.parametrize("busy", [False, True])
def test_a_pool_that_is_closed_while_it_starts_leaves_no_process(
    setup: Setup, start: str, after_s: float, busy: bool
) -> None:
    pool: WorkerPool[Job, object] = WorkerPool(setup, 3, caller_is_busy=busy)
    future = pool.submit(Job("sleep", 600))
    time.sleep(after_s)
    pool.close()
    assert pool.pids == []
    with pytest.raises(CancelledError):
        future.result(DEADLINE_S)


def test_a_pool_that_is_closed_starts_no_more_processes(
    setup: Setup, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The last process starts when the others are up; nobody should wait for it in vain."""
    started: list[object] = []
    popen = subprocess.Popen

    def count(*arguments: object, **options: object) -> object:
        started.append(arguments)
        return popen(*arguments, **options)  # type: ignore[call-overload]

    monkeypatch.setattr("holdfast.workers.pool.can_fork", lambda: False)
    monkeypatch.setattr(subprocess, "Popen", count)
    pool: WorkerPool[Job, object] = WorkerPool(setup, 3, caller_is_busy=True)
    while not started:
        time.sleep(0.01)
    pool.close()
    assert 1 <= len(started) <= 2


ORPHANS = """
import sys, time
sys.path.insert(0, sys.argv[1])
import holdfast.workers.pool
from holdfast.workers import WorkerPool
from toy_setup import Job, Setup
if sys.argv[2] == "copies":
    assert holdfast.workers.pool.can_fork()
else:
    holdfast.workers.pool.can_fork = lambda: False
pool = WorkerPool(Setup(), 2)
jobs = [pool.submit(Job("sleep", 600)) for _ in range(2)]
assert pool.wait_until_complete(60.0)
print(*pool.pids, flush=True)
time.sleep(600)
"""


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.skipif(
    not Path("/proc/self/task").exists(), reason="copies are made where threads can be counted"
)
@pytest.mark.parametrize("how", ["copies", "fresh"])
def test_processes_end_with_the_one_that_started_them_even_at_work(how: str) -> None:
    """It is killed, so that it can tell them nothing; they hold its pipes no longer."""
    command = [sys.executable, "-c", ORPHANS, str(Path(__file__).parent), how]
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=alone
    ) as parent:
        assert parent.stdout is not None and parent.stderr is not None
        pids = [int(word) for word in parent.stdout.readline().split()]
        programs = [Path(f"/proc/{pid}/cmdline").read_text("utf-8") for pid in pids]
        parent.kill()
        # Ends only when all that hold the pipe are gone, which they share with their parent.
        assert parent.stderr.read() == ""
    assert len(pids) == 2
    assert all(("holdfast.workers.process" in program) is (how == "fresh") for program in programs)
    deadline = time.monotonic() + DEADLINE_S
    while any(is_running(pid) for pid in pids):
        assert time.monotonic() < deadline
        time.sleep(0.01)
