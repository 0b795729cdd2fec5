"""What the pool asks of the work it shares: a setup that makes workers, and workers that do jobs."""

from collections.abc import Sequence
from concurrent.futures import Future
from types import TracebackType
from typing import Protocol, Self, TypeVar

__all__ = ["Pool", "Worker", "WorkerSetup"]

JobT = TypeVar("JobT")
JobT_contra = TypeVar("JobT_contra", contravariant=True)
ResultT_co = TypeVar("ResultT_co", covariant=True)
ResultT = TypeVar("ResultT")


class Worker(Protocol[JobT_contra, ResultT_co]):
    """Does jobs, one at a time; what becomes of one depends on the setup and the job alone."""

    def work(self, job: JobT_contra, /) -> ResultT_co:
        """Does a job; an exception that it raises is raised again by the job's future."""


class WorkerSetup(Protocol[JobT_contra, ResultT_co]):
    """What all workers of a pool have in common; it is pickled, and each process is sent it once."""

    @property
    def shared(self) -> Sequence[object]:
        """Large objects of the setup to which jobs and results refer.

        Both ends have them, so a message holds their place in this sequence instead of their content. It is
        their identity that counts: what arrives in place of `setup.shared[k]` is `setup.shared[k]` of the
        other end. Empty where nothing is worth it.
        """

    def new_worker(self) -> Worker[JobT_contra, ResultT_co]:
        """Makes the worker of a process, with everything loaded that its first job would have to wait for."""

    def give_up(self, job: JobT_contra, /) -> ResultT_co:
        """The result of a job that ended every process that began it."""


class Pool(Protocol[JobT_contra, ResultT]):
    """Whoever has jobs done: processes of this machine, or a cluster."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    @property
    def ready(self) -> bool:
        """Whether some worker is up, so that a job doesn't wait for one to start."""

    @property
    def complete(self) -> bool:
        """Whether all are up."""

    def submit(self, job: JobT_contra) -> "Future[ResultT]":
        """Has a job done; see `WorkerPool.submit`."""

    def close(self) -> None:
        """Ends all of it; jobs that are not done are cancelled."""
