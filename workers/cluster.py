"""A Dask cluster whose workers do jobs; a worker that is killed costs only what it was doing."""

import logging
import pickle
import re
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Generic, Self, TypeVar

from .. import __version__
from ..base.machine.extras import from_extra
from ..errors import InputError
from .contract import WorkerSetup
from .limit import TimeOver
from .messages import Codec, ProcessLost
from .relay import do_job, installed_version
from .remote import WorkFailed

__all__ = ["Cluster", "ClusterPool", "connected"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

_ADDRESS = re.compile(r"[a-z]+://[^/\s]+:[0-9]{1,5}")
_CONNECT_S = 15.0
_FIRST_WORKER_S = 60.0


class Cluster:
    """A cluster that this process is connected to; see `connected`.

    Attributes:
        address: of its scheduler.
        client: the connection.
    """

    def __init__(self, address: str, client: Any):
        self.address, self.client = address, client

    @property
    def threads(self) -> int:
        """Jobs that it does at a time, as far as its workers are up."""
        workers = self.client.scheduler_info(n_workers=-1)["workers"].values()
        return sum(worker["nthreads"] for worker in workers)

    def check_workers(self) -> None:
        """Waits for the first worker, and looks whether all have this version.

        Raises:
            InputError: none comes, or one has another version or none.
        """
        try:
            self.client.wait_for_workers(1, timeout=_FIRST_WORKER_S)
        except TimeoutError:
            raise InputError("--cluster", self.address, "has no workers") from None
        for worker, found in self.client.run(installed_version, on_error="return").items():
            if isinstance(found, Exception):
                raise InputError("--cluster", worker, "has no Holdfast: install it there, too")
            if found != __version__:
                raise InputError("--cluster", worker, f"has version {found!r}, but this is {__version__!r}")


@contextmanager
def connected(address: str) -> Iterator[Cluster]:
    """A connection to the cluster whose scheduler is at an address, such as `tcp://head:8786`.

    Raises:
        InputError: there is none, or its workers can't be used.
        MissingBackend: distributed is not installed.
    """
    distributed = from_extra("distributed", "cluster", "a cluster")
    if not _ADDRESS.fullmatch(address):
        raise InputError("--cluster", address, "must be the address of a scheduler, such as tcp://head:8786")
    # What it logs of workers that come and go is for those who run the cluster.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(address, timeout=_CONNECT_S, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise InputError("--cluster", address, f"can't be reached: {reason}") from None
    try:
        cluster = Cluster(address, client)
        cluster.check_workers()
        yield cluster
    finally:
        client.close(timeout=2)


class ClusterPool(Generic[JobT, ResultT]):
    """Has jobs done by a cluster; what it promises is what `WorkerPool` does.

    Args:
        cluster: where.
        setup: what all jobs have in common.
        limit_s: how long a job may take once it is begun.
    """

    def __init__(self, cluster: Cluster, setup: WorkerSetup[JobT, ResultT], *, limit_s: float | None = None):
        self._cluster, self._setup, self._limit_s = cluster, setup, limit_s
        self._codec = Codec(setup.shared)
        pickled = pickle.dumps(setup, protocol=pickle.HIGHEST_PROTOCOL)
        # A task and no data that is scattered: it is made again where the workers that held it are lost.
        self._sent = cluster.client.submit(_itself, pickled, pure=False)
        self._open: dict[Future[ResultT], Any] = {}
        self._guard = threading.Lock()
        self._closed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def ready(self) -> bool:
        """True: the cluster was up before."""
        return True

    @property
    def complete(self) -> bool:
        """True: workers that come later are used when they come."""
        return True

    def submit(self, job: JobT) -> "Future[ResultT]":
        """Has a job done by a worker that is free; see `WorkerPool.submit`."""
        promise: Future[ResultT] = Future()
        message = self._codec.encode(job)
        there = self._cluster.client.submit(do_job, self._sent, message, self._limit_s, pure=False)
        with self._guard:
            self._open[promise] = there

        def forget(_: "Future[ResultT]") -> None:
            with self._guard:
                self._open.pop(promise, None)
            if promise.cancelled() and not there.done():
                there.cancel()

        promise.add_done_callback(forget)
        there.add_done_callback(lambda done: self._settle(promise, job, done))
        return promise

    def close(self) -> None:
        """Cancels the jobs that are not done."""
        self._closed = True
        with self._guard:
            promises = list(self._open)
        for promise in promises:
            promise.cancel()
        self._sent.release()

    def _settle(self, promise: "Future[ResultT]", job: JobT, there: Any) -> None:
        """Gives a promise what became of its job."""
        if self._closed or not promise.set_running_or_notify_cancel():
            return
        try:
            promise.set_result(self._result(job, there))
        except Exception as error:  # noqa: BLE001 - raised again by the promise
            promise.set_exception(error)

    def _result(self, job: JobT, there: Any) -> ResultT:
        if there.status == "cancelled":
            raise InputError("--cluster", self._cluster.address, "is gone")
        error = there.exception()
        if isinstance(error, TimeOver):
            raise error
        if isinstance(error, WorkFailed):
            raise error.error
        # Of the first every process died, of the second every worker.
        if isinstance(error, ProcessLost) or type(error).__name__ == "KilledWorker":
            return self._setup.give_up(job)
        if error is not None:
            raise error
        done, answer = self._codec.decode(there.result())
        if not done:
            raise answer
        result: ResultT = answer
        return result


def _itself(value: bytes) -> bytes:
    return value
