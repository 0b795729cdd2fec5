"""Where the jobs of a command are done: processes of this machine, or a cluster."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

from .cluster import Cluster, ClusterPool, connected
from .contract import Pool, WorkerSetup
from .pool import WorkerPool

__all__ = ["open_pool", "using_cluster"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")

_cluster: ContextVar[Cluster | None] = ContextVar("cluster", default=None)


@contextmanager
def using_cluster(address: str | None) -> Iterator[Cluster | None]:
    """Within it, pools that are opened are on a cluster; None leaves them on this machine.

    Args:
        address: of the cluster's scheduler, such as `tcp://head:8786`.

    Raises:
        InputError: there is no cluster, or its workers can't be used.
        MissingBackend: distributed is not installed.
    """
    if address is None:
        yield None
        return
    with connected(address) as cluster:
        token = _cluster.set(cluster)
        try:
            yield cluster
        finally:
            _cluster.reset(token)


def open_pool(
    setup: WorkerSetup[JobT, ResultT],
    count: int,
    *,
    caller_is_busy: bool = False,
    limit_s: float | None = None,
) -> Pool[JobT, ResultT]:
    """A pool of so many processes, or the cluster in use, whose workers are as many as there are."""
    cluster = _cluster.get()
    if cluster is not None:
        return ClusterPool(cluster, setup, limit_s=limit_s)
    return WorkerPool(setup, count, caller_is_busy=caller_is_busy, limit_s=limit_s)
