"""A Dask cluster does jobs as processes of this machine do, whatever of it is killed."""

import os
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.objects import load_task
from holdfast.solver import solve
from holdfast.solver.search import job_queue
from holdfast.workers import ClusterPool, TimeOver, WorkerPool, open_pool, using_cluster


@dataclass(frozen=True)
class SquaringSetup:
    """Squares numbers; kills its process, or the cluster's worker above it, over some of them, once.

    Attributes:
        marks: folder that remembers what was killed.
    """

    marks: str

    @property
    def shared(self) -> tuple[object, ...]:
        return ()

    def new_worker(self) -> "Squaring":
        return Squaring(self)

    def give_up(self, job: tuple[str, int]) -> int:
        return -1


class Squaring:
    def __init__(self, setup: SquaringSetup):
        self._marks = Path(setup.marks)

    def work(self, job: tuple[str, int]) -> int:
        what, number = job
        mark = self._marks / f"{what}-{number}"
        if what == "sleep":
            time.sleep(3600.0)
        if what == "fail":
            raise InputError("squares", str(number), "is none")
        if what == "die":
            os.kill(os.getpid(), signal.SIGKILL)
        if what in ("die once", "kill the worker once") and not mark.exists():
            mark.touch()
            os.kill(os.getpid() if what == "die once" else os.getppid(), signal.SIGKILL)
        return number * number


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    distributed = pytest.importorskip("distributed")
    import dask

    quiet = {"distributed.worker.daemon": False, "logging.distributed": "critical"}
    with (
        dask.config.set(quiet),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=50
        ) as cluster,
    ):
        yield cluster.scheduler_address


@pytest.mark.slow
def test_what_is_killed_costs_nothing(address: str, tmp_path: Path) -> None:
    jobs = [("square", k) for k in range(6)]
    jobs += [("die once", 6), ("kill the worker once", 7), ("die", 8), ("square", 9)]
    setup = SquaringSetup(str(tmp_path))
    with using_cluster(address) as cluster, open_pool(setup, 1) as pool:
        assert cluster is not None and cluster.threads >= 1 and isinstance(pool, ClusterPool)
        futures = [pool.submit(job) for job in jobs]
        failing = pool.submit(("fail", 3))
        assert [future.result() for future in futures] == [0, 1, 4, 9, 16, 25, 36, 49, -1, 81]
        with pytest.raises(InputError, match="squares: 3: is none"):
            failing.result()
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("place", ["here", "cluster"])
def test_a_job_that_hangs_is_ended(place: str, address: str, tmp_path: Path) -> None:
    with (
        using_cluster(address if place == "cluster" else None),
        open_pool(SquaringSetup(str(tmp_path)), 1, limit_s=0.5) as pool,
    ):
        assert isinstance(pool, ClusterPool if place == "cluster" else WorkerPool)
        hanging, after = pool.submit(("sleep", 1)), pool.submit(("square", 3))
        with pytest.raises(TimeOver, match="did not end within 0 s"):
            hanging.result()
        assert after.result() == 9


def test_a_tree_on_the_cluster_is_the_serial_one(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(job_queue, "PATIENCE_S", 0.0)
    task = load_task("upholding")
    alone = solve(task, candidates=60, pure=False, budget_s=900.0)
    with using_cluster(address):
        together = solve(task, candidates=60, budget_s=900.0, workers=2)
    assert (together.boxes, together.lps) == (alone.boxes, alone.lps)
    assert [c.state.q.tolist() for c in together] == [c.state.q.tolist() for c in alone]


@pytest.mark.parametrize("wrong", ["nonsense", "tcp://no", "", "tcp://a b:1", "127.0.0.1:8786"])
def test_an_address_that_is_none(wrong: str) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="must be the address"), using_cluster(wrong):
        pass
