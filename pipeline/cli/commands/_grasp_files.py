"""Grasp files of what a solver found."""

from pathlib import Path

from ....files import write_json
from ....objects import Task
from ...records import GraspFile, Solution, file_head, to_json

__all__ = ["write_grasps"]


def write_grasps(folder: Path, solutions: list[Solution], task: "Task", reference: str) -> None:
    """Writes each solution as a grasp file, named by its id, into a folder."""
    for solution in solutions:
        path = folder / f"{solution.id}.json"
        head = file_head(task, reference, path)
        write_json(path, to_json(GraspFile.model_validate({**solution.model_dump(), **head})))
