"""Worker processes that share the pieces of a long piece of work; one that dies costs only its piece.

How it is used: write a *setup* and a *worker* (the protocols `WorkerSetup` and `Worker`), both in a module
that a fresh process can import. The setup holds what is the same for every job and makes a worker in each
process; the worker does jobs. Jobs and results are anything that can be pickled.

    @dataclass(frozen=True, eq=False)
    class RetractSetup:
        task: Task

        @property
        def shared(self) -> tuple[object, ...]:
            return (self.task,)  # whole meshes, which configurations refer to: no message holds them again

        def new_worker(self) -> "RetractWorker":
            return RetractWorker(self)

        def give_up(self, job: Configuration) -> Outcome:
            return Outcome.LOST

    with WorkerPool(RetractSetup(task), count=4) as pool:
        futures = [pool.submit(configuration) for configuration in found]
        for future in futures:
            print(future.result())

A process that is killed, or crashes, costs the job that it was doing: another process begins that anew, and
after three losses its result is what `give_up` makes of it. An exception that the worker raises comes back as
that of `future.result()`. Closing the pool, or leaving the `with`, ends all processes at once.

`open_pool` in place of `WorkerPool` opens it where the command says: within `using_cluster(address)` it is
the Dask cluster there, with the same promises; each job travels to a process of the cluster's worker.
"""

from .cluster import Cluster, ClusterPool
from .contract import Pool, Worker, WorkerSetup
from .forked import can_fork
from .limit import TimeOver
from .place import open_pool, using_cluster
from .pool import WorkerPool, available_cores

__all__ = [
    "Cluster",
    "ClusterPool",
    "Pool",
    "TimeOver",
    "Worker",
    "WorkerPool",
    "WorkerSetup",
    "available_cores",
    "can_fork",
    "open_pool",
    "using_cluster",
]
