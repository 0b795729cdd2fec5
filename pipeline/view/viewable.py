"""What can be viewed: a grasp file, or all grasps of a run."""

from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError
from ...objects import Task, load_task
from ..records import (
    GraspRecord,
    RunFolder,
    existing_source,
    load_grasp_task,
    read_grasp,
    to_state,
)
from ..report import Motion, motions

__all__ = ["Viewable", "load_viewables"]


@dataclass(frozen=True, eq=False)
class Viewable:
    """A grasp with what it does.

    Attributes:
        record: the grasp.
        task: it is of.
        motions: its approach, and its test in each direction that was recorded.
        path: of its file, whose model lies beside it with the suffix `.xml`.
    """

    record: GraspRecord
    task: Task
    motions: tuple[Motion, ...]
    path: Path


def load_viewables(path: Path, task_name: str | None = None) -> list[Viewable]:
    """The grasps of a run folder, the best first, or the one of a grasp file.

    Args:
        path: of either.
        task_name: a task in place of the one that the files name.

    Raises:
        InputError: neither, a run without grasps, or what can't be read.
    """
    if not path.is_dir():
        record = read_grasp(path)
        return [_viewable(record, load_grasp_task(record, path, task_name), path)]
    folder = RunFolder(path)
    run = folder.load()
    if not run.grasps:
        raise InputError(folder.record_path, "grasps", "is empty: there is no grasp to view")
    task = load_task(task_name or existing_source(run.task_source, folder.record_path))
    return [_viewable(grasp, task, folder.grasp_path(grasp.id)) for grasp in run.grasps]


def _viewable(record: GraspRecord, task: Task, path: Path) -> Viewable:
    to_state(record, task, path)  # refuses what is none of this task
    return Viewable(record, task, tuple(motions(record, task, str(path))), path)
