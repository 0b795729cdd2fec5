"""What a search asks of whoever works on its slices, in this process or in another."""

from typing import Protocol, TypeVar

from ..objects import Task

__all__ = ["SearchSetup", "SliceWorker"]

JobT = TypeVar("JobT")
ResultT = TypeVar("ResultT")


class SearchSetup(Protocol[JobT, ResultT]):
    """What decides the result of every slice; each process is sent it once."""

    @property
    def task(self) -> Task | None:
        """The task that is searched, if any; messages leave it out, for both ends have it."""

    def new_worker(self) -> "SliceWorker[JobT, ResultT]":
        """Somebody to work on slices."""

    def give_up(self, job: JobT) -> ResultT:
        """What becomes of a slice that ended every process that worked on it: it is left undecided."""


class SliceWorker(Protocol[JobT, ResultT]):
    """Works on slices; what becomes of one depends on the setup and the job alone."""

    @property
    def setup(self) -> SearchSetup[JobT, ResultT]:
        """What it was made from."""

    def work(self, job: JobT, /) -> ResultT:
        """Works on a slice."""
