"""The record that a run starts from: a fresh one, or what an earlier run left."""

from pathlib import Path

from ...errors import InputError
from ..records import RunFolder, RunRecord, Solve
from .ranking import number

__all__ = ["begin"]


def begin(fresh: RunRecord, folder: RunFolder, *, resume: bool) -> RunRecord:
    """The record to start from.

    Args:
        fresh: the record of a run that has done nothing yet.
        folder: where the run is.
        resume: whether to go on with what lies there, if anything does.

    Raises:
        InputError: the folder holds something else, or a run with another task, seed or settings.
    """
    if not resume or not folder.record_path.exists():
        folder.start(fresh)
        return fresh
    earlier = _without_broken_round(folder.load())
    _check_same(fresh, earlier, folder.record_path)
    return earlier


def _check_same(fresh: RunRecord, earlier: RunRecord, source: Path) -> None:
    for name in ("task", "task_fingerprint", "seed"):
        if getattr(fresh, name) != getattr(earlier, name):
            raise InputError(
                source,
                name,
                f"is {getattr(earlier, name)!r}, but this run's is {getattr(fresh, name)!r}: can't resume",
            )
    for name, value in fresh.settings.items():
        if earlier.settings.get(name) != value:
            raise InputError(
                source,
                f"settings.{name}",
                f"is {earlier.settings.get(name)!r}, but this run's is {value!r}: can't resume",
            )


def _without_broken_round(record: RunRecord) -> RunRecord:
    """The record without a round that was stopped midway: a resumed run does it again, in full."""
    if record.solve is None or record.solve.rounds[-1].whole:
        return record
    rounds = record.solve.rounds[:-1]
    kept = sum(entry.found for entry in rounds)
    grasps = [grasp for grasp in record.grasps if number(grasp) <= kept]
    solve_record = Solve.of(rounds, record.solve.sigma) if rounds else None
    return record.model_copy(update={"solve": solve_record, "grasps": grasps})
