"""What is missing of a run beside its record, and what of it can be made from that."""

from pathlib import Path

from ...errors import InputError
from ...mjcf import HoldSettings, trial_mjcf
from ...objects import Task
from ..records import (
    GraspFile,
    GraspRecord,
    RunFolder,
    RunRecord,
    file_head,
    read_grasp,
    to_configuration,
)
from ..report import missing_pictures
from .recorded_grasp import to_grasp

__all__ = ["missing_pages", "restore_grasps"]


def restore_grasps(
    task: Task, record: RunRecord, folder: RunFolder, settings: HoldSettings, reference: str
) -> list[Path]:
    """Writes the files of finished grasps that are missing or damaged; gives their paths.

    Raises:
        InputError: the record of a grasp is none of this task.
    """
    restored = []
    for grasp in record.grasps:
        if not grasp.is_done:
            continue
        head = file_head(task, reference, folder.grasp_path(grasp.id))
        file = GraspFile.model_validate({**dict(grasp), **head})
        lacks = [path for path in (folder.grasp_path(grasp.id),) if not _is_whole(path, file)]
        lacks += [path for path in (folder.grasp_path(grasp.id, ".xml"),) if not path.is_file()]
        if lacks:
            folder.save_grasp(file, _mjcf(grasp, task, folder, settings))
            restored += lacks
    return restored


def missing_pages(record: RunRecord, folder: RunFolder) -> list[Path]:
    """Pictures and the report that a whole run has and this folder lacks."""
    missing = [] if record.quick else missing_pictures(record, folder)
    return missing if folder.report_path.is_file() else [*missing, folder.report_path]


def _is_whole(path: Path, file: GraspFile) -> bool:
    try:
        found = read_grasp(path).model_copy(update={"holdfast": file.holdfast})
        # The record of a large run has no motions of most of its grasps.
        return (found if file.has_motion else found.without_motion()) == file
    except InputError:
        return False


def _mjcf(grasp: GraspRecord, task: Task, folder: RunFolder, settings: HoldSettings) -> str:
    """The model of a grasp as its record describes it."""
    simulated = to_grasp(grasp, task, settings, folder.record_path)
    if simulated is None:
        return trial_mjcf(to_configuration(grasp, task, folder.record_path), settings=settings)
    return simulated.mjcf(settings)
