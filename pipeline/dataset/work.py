"""Whoever makes parts: a worker in a process, or this process itself."""

from dataclasses import dataclass
from time import process_time
from typing import NamedTuple

from ...base.machine.backend import configure
from .part import Part, make_part
from .plan import DatasetPlan, SituationPlan

__all__ = ["MadePart", "PartSetup", "PartWorker"]


class MadePart(NamedTuple):
    """A part, and what it took.

    Attributes:
        part: what was made.
        cpu_s: time of the processor.
    """

    part: Part
    cpu_s: float


@dataclass(frozen=True, eq=False)
class PartSetup:
    """What all workers have in common."""

    plan: DatasetPlan

    @property
    def shared(self) -> tuple[object, ...]:
        """Nothing large."""
        return ()

    def new_worker(self) -> "PartWorker":
        """Makes a worker."""
        return PartWorker(self.plan)

    def give_up(self, job: SituationPlan, /) -> MadePart:
        """A situation that ended every process that began it."""
        blank = Part(
            plan=(job.object, job.hand), rank=job.rank, refused={"every process broke down on it": 1}
        )
        return MadePart(blank, 0.0)


class PartWorker:
    """Makes parts, one at a time."""

    def __init__(self, plan: DatasetPlan):
        configure()  # before anything imports MuJoCo, which settles on its renderer then
        self._plan = plan

    def work(self, job: SituationPlan, /) -> MadePart:
        """Makes a part."""
        started = process_time()
        part = make_part(job, self._plan)
        return MadePart(part, process_time() - started)
