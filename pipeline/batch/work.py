"""The job of a batch: one item from its name to its run folder, in a process that it may break."""

import os
import time
from dataclasses import dataclass, replace
from pathlib import Path

from ...errors import HoldfastError, InputError, UnknownName
from ..run import RunSettings, run_task
from ..run_object import GraspRequest, run_object
from .in_folder import MESHES, TASK_FILES
from .item import Item
from .outcome import Outcome, RunOutcome

__all__ = ["BatchSetup"]


@dataclass(frozen=True)
class BatchSetup:
    """What all items have in common.

    Attributes:
        folder: of the batch, as every worker reaches it.
        settings: of each run.
        request: what is asked of meshes, with the path of none.
    """

    folder: Path
    settings: RunSettings
    request: GraspRequest

    @property
    def shared(self) -> tuple[object, ...]:
        """Nothing: jobs are names."""
        return ()

    def new_worker(self) -> "BatchWorker":
        """Makes the worker of a process."""
        return BatchWorker(self)

    def give_up(self, job: Item, /) -> Outcome:
        """The outcome of an item that ended every process that began it."""
        reason = "every process that worked on it broke down"
        return Outcome(reference=job.reference, name=job.name, state="lost", reason=reason)


class BatchWorker:
    """Runs items, one at a time.

    Args:
        setup: what they have in common.
    """

    def __init__(self, setup: BatchSetup):
        self._setup = setup

    def work(self, item: Item, /) -> Outcome:
        """Runs an item, or goes on with what an earlier process has left of it.

        Raises:
            InputError: the batch's own folder can't be read or written, which no other item can do better.
        """
        started = time.monotonic()
        folder = self._setup.folder
        if not (folder / "batch.json").is_file():
            raise InputError(folder, "", "is not reached by a worker: it must be a folder that all share")
        try:
            runs = self._mesh(item) if item.is_mesh else self._task(item)
        except (HoldfastError, MemoryError, OSError) as error:
            if _is_of_the_folder(error, folder):
                raise
            return self._failed(item, str(error) or "out of memory", started)
        except Exception as error:  # noqa: BLE001 - one item's failure, whatever it is, is never the batch's
            return self._failed(item, f"{type(error).__name__}: {error}", started)
        return Outcome(
            reference=item.reference,
            name=item.name,
            state="done",
            runs=runs,
            seconds=time.monotonic() - started,
        )

    def _task(self, item: Item) -> list[RunOutcome]:
        path = self._path(item)
        try:
            record = run_task(item.reference, path, self._setup.settings, resume=True)
        except UnknownName as error:
            if error.name == item.reference and os.path.exists(error.name):
                raise InputError(error.name, "", f"is neither a {TASK_FILES} nor a {MESHES}") from None
            raise
        return [RunOutcome.of(record, self._relative(path))]

    def _mesh(self, item: Item) -> list[RunOutcome]:
        request = replace(self._setup.request, object=item.reference)
        done = run_object(request, self._path(item), self._setup.settings, resume=True, force=True)
        last = {attempt.folder: attempt for attempt in done.attempts}
        return [RunOutcome.of(attempt.record, self._relative(folder)) for folder, attempt in last.items()]

    def _path(self, item: Item) -> Path:
        return self._setup.folder / "runs" / item.name

    def _relative(self, path: Path) -> str:
        return os.path.relpath(path, self._setup.folder)

    def _failed(self, item: Item, reason: str, started: float) -> Outcome:
        return Outcome(
            reference=item.reference,
            name=item.name,
            state="failed",
            reason=reason,
            seconds=time.monotonic() - started,
        )


def _is_of_the_folder(error: Exception, folder: Path) -> bool:
    """Whether the batch's folder can't be written or used, for its disk is full, say."""
    if isinstance(error, InputError):
        named, is_access = error.source, error.allowed.startswith("can't be")
    else:
        named, is_access = str(getattr(error, "filename", None) or ""), isinstance(error, OSError)
    return is_access and os.path.abspath(named).startswith(os.path.abspath(folder) + os.sep)
