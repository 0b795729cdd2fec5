"""The record that a run starts from: a fresh one, or what an earlier run left."""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from ...errors import InputError
from ..records import RunFolder, RunRecord, Solve, difference
from .ranking import number

__all__ = ["begin", "folder_name", "free_folder", "own_folder"]

_MOST_FOLDERS = 1000
_LONGEST_NAME = 64


def begin(fresh: RunRecord, folder: RunFolder, *, resume: bool, force: bool = False) -> RunRecord:
    """The record to start from.

    Args:
        fresh: the record of a run that has done nothing yet.
        folder: where the run is.
        resume: whether to go on with what lies there, if anything does.
        force: whether another run may be replaced.

    Raises:
        InputError: the folder holds something else, or a run with another task, seed or settings, or, where
            it is to be resumed, of another version.
    """
    folder.remove_parts()
    if not resume or not folder.record_path.exists():
        folder.start(fresh, force=force)
        return fresh
    earlier = _without_broken_round(folder.load())
    if earlier.holdfast != fresh.holdfast:
        found = f"is {earlier.holdfast[:40]!r}, but this is {fresh.holdfast!r}"
        raise InputError(folder.record_path, "holdfast", f"{found}: can't resume another version's run")
    if found_difference := difference(fresh, earlier):
        raise InputError(folder.record_path, found_difference.field, found_difference.words)
    return earlier


def own_folder(base: Path, fresh: RunRecord) -> Path:
    """The folder for a run where the user names none: `base`, or with a number where another run lies there.

    The same run, by task, seed and settings, comes back to the folder it was in.
    """
    for folder in _numbered(base):
        if folder.is_free:
            return folder.path
        with suppress(InputError):  # something else, which stays as it is
            if difference(fresh, folder.load()) is None:
                return folder.path
    raise InputError(base, "", f"{_MOST_FOLDERS} folders of runs lie there already: name one by --out")


def folder_name(task_name: str) -> str:
    """The task's name as the name of a folder: what a path could take for something else becomes `_`."""
    plain = "".join(c if c.isalnum() or c in "-_" else "_" for c in task_name)
    # Short enough for what is put behind it, such as a number.
    return plain[:_LONGEST_NAME] or "_"


def free_folder(base: Path) -> Path:
    """`base`, or with a number, whichever is the first that nothing lies in."""
    return next(
        (folder.path for folder in _numbered(base) if folder.is_free),
        base,
    )


def _numbered(base: Path) -> Iterator[RunFolder]:
    yield RunFolder(base)
    for i in range(2, _MOST_FOLDERS):
        yield RunFolder(base.with_name(f"{base.name}_{i}"))


def _without_broken_round(record: RunRecord) -> RunRecord:
    """The record without a round that was stopped midway: a resumed run does it again, in full."""
    if record.solve is None or record.solve.rounds[-1].whole:
        return record
    rounds = record.solve.rounds[:-1]
    kept = sum(entry.found for entry in rounds)
    grasps = [grasp for grasp in record.grasps if number(grasp) <= kept]
    solve_record = Solve.of(rounds, record.solve.sigma) if rounds else None
    return record.model_copy(update={"solve": solve_record, "grasps": grasps})
