"""The stages after the solver, grasp by grasp, in this process or in several."""

import multiprocessing
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ...mjcf import HoldSettings, trial_mjcf
from ...objects import Task, load_task
from ...retraction import RetractionSettings
from ..records import GraspRecord, to_configuration
from .stages import Extras, hold_grasp, place_grasp

__all__ = ["GraspJob", "Tried", "try_grasps"]

_EXTRAS = Extras(margin=True, agreement=True)
# Grasps that are handed out ahead of those whose turn it is, by worker: none of them waits for long.
_AHEAD = 2


@dataclass(frozen=True)
class GraspJob:
    """What the stages after the solver need.

    Attributes:
        reference: the task, as the user named it.
        source: file that the grasps come from, for messages.
        hold: settings of the physical test.
        retraction: settings of retraction.
    """

    reference: str
    source: Path
    hold: HoldSettings
    retraction: RetractionSettings


@dataclass(frozen=True)
class Tried:
    """A grasp after the stages, with its model as MJCF."""

    record: GraspRecord
    mjcf: str


def try_grasps(
    grasps: Sequence[GraspRecord],
    job: GraspJob,
    task: Task,
    *,
    workers: int = 1,
    should_stop: Callable[[], bool],
) -> Iterator[Tried]:
    """Retracts, squeezes and holds grasps; gives them in their order, each as soon as it is done.

    What comes out does not depend on the number of workers.

    Args:
        grasps: what the solver found.
        job: what to do with them.
        task: the job's task, loaded.
        workers: number of processes; with 1, this one does it all.
        should_stop: looked at before each grasp is begun; those that were begun are finished.
    """
    if workers == 1 or len(grasps) < 2:
        for grasp in grasps:
            if should_stop():
                return
            yield _try(grasp, job, task)
        return
    # Fresh processes: MuJoCo, numba and OpenGL don't survive a fork in the middle of their work.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(grasps)), context, _ignore_interrupts) as pool:
        waiting: deque[Future[Tried]] = deque()
        for grasp in grasps:
            if should_stop():
                break
            waiting.append(pool.submit(_try_elsewhere, grasp, job))
            if len(waiting) >= _AHEAD * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


def _try(grasp: GraspRecord, job: GraspJob, task: Task) -> Tried:
    # From the written form even where the solver's own is at hand: a resumed run has no other.
    configuration = to_configuration(grasp, task, job.source)
    cleared, placed = place_grasp(grasp, configuration, job.hold, job.retraction)
    if placed is None:
        return Tried(cleared, trial_mjcf(configuration, settings=job.hold))
    return Tried(*hold_grasp(cleared, placed.configuration, job.hold, _EXTRAS, placed.approach))


def _try_elsewhere(grasp: GraspRecord, job: GraspJob) -> Tried:
    return _try(grasp, job, _load(job.reference))


@cache
def _load(reference: str) -> Task:
    return load_task(reference)


def _ignore_interrupts() -> None:
    """Ctrl-C goes to every process of a terminal; the one that hands out the work answers it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
