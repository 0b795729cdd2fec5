"""How grasps and runs name the task that they were made for."""

import os
from pathlib import Path

from ... import __version__
from ...base.files.file_paths import real_path
from ...base.files.output_file import write_json
from ...errors import InputError
from ...hands import HAND_SUFFIXES
from ...objects import Task, builtin_tasks, load_task, split_reference, with_hand
from ...objects.families import FAMILIES, FAMILY_PREFIX
from .fingerprint import fingerprint
from .grasp import GraspFile
from .solution import Solution, to_json

__all__ = [
    "builtin_reference",
    "existing_source",
    "file_head",
    "load_grasp_task",
    "relative_source",
    "resolve_source",
    "write_solutions",
]


_NO_SOURCE = "is empty, as it was written from Python: name the task by `--task`, in Python by `task=`"


def builtin_reference(task: Task) -> str:
    """The name by which a task can be loaded where it is built in or of a family; empty for others."""
    # Those in folders are named after them too; no other file needs to be loaded.
    names = [name for name in builtin_tasks() if name.replace("/", "_") == task.name]
    family, _, seed = task.name.rpartition("_")
    if family in FAMILIES and seed.isascii() and seed.isdigit() and len(seed) < 10:
        names.append(f"{FAMILY_PREFIX}{family}:{seed}")
    return next((name for name in names if fingerprint(load_task(name)) == fingerprint(task)), "")


def load_grasp_task(grasp: GraspFile, path: Path, override: str | None = None) -> Task:
    """The task of a grasp file at `path`, or the one named instead.

    Raises:
        InputError: no such task, or a file that can't be used.
    """
    return load_task(override or existing_source(grasp.task_source, path))


def existing_source(task_source: str, path: Path) -> str:
    """As `resolve_source`, of files that are there.

    Raises:
        InputError: it names none, or a file that is not there, as where one of the two was moved.
    """
    found = resolve_source(task_source, path)
    for name in split_reference(found):
        if name is not None and name.lower().endswith(HAND_SUFFIXES) and not Path(name).exists():
            said = f"{name} is not there: put it back, as seen from this file"
            raise InputError(path, "task_source", f"{said}; many commands take another task by --task")
    return found


def resolve_source(task_source: str, path: Path) -> str:
    """A task as named in the file `path`: built-in names as they are, paths from that file's folder.

    Raises:
        InputError: it names none.
    """
    if not task_source:
        raise InputError(path, "task_source", _NO_SOURCE)
    task, hand = split_reference(task_source)
    return with_hand(_resolved(task, path), None if hand is None else _resolved(hand, path))


def _resolved(name: str, path: Path) -> str:
    return str(path.parent / name) if name.lower().endswith(HAND_SUFFIXES) else name


def relative_source(task: str, path: Path) -> str:
    """How the file `path` names the task: built-in names as they are, paths from that file's folder.

    What is empty, for a task without a name or file to load it by, stays so.
    """
    task, hand = split_reference(task)
    return with_hand(_relative(task, path), None if hand is None else _relative(hand, path))


def _relative(name: str, path: Path) -> str:
    if not name.lower().endswith(HAND_SUFFIXES):
        return name
    return os.path.relpath(real_path(Path(name)), real_path(path).parent)


def file_head(task: Task, reference: str, path: Path) -> dict[str, str]:
    """Fields that a grasp has in a file of its own, `path`; `reference` is how the user named the task."""
    return {
        "holdfast": __version__,
        "task": task.name,
        "task_source": relative_source(reference, path),
        "task_fingerprint": fingerprint(task),
        "hand": task.hand.name,
        "object_name": task.object.name,
    }


def write_solutions(folder: Path, solutions: list[Solution], task: Task, reference: str) -> None:
    """Writes each solution as a grasp file, named by its id, into a folder."""
    for solution in solutions:
        path = folder / f"{solution.id}.json"
        head = file_head(task, reference, path)
        write_json(path, to_json(GraspFile.model_validate({**solution.model_dump(), **head})))
