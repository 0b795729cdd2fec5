"""What `holdfast export` is given: runs and grasps of ours, with their task, or files of other programs."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .....base.text.console import Console
from .....base.text.plain_text import counted
from .....errors import InputError, UnknownName
from .....objects import Task, load_task
from ....exports import PlacedGrasp, placed_grasps, placed_records
from ....formats import QUESTIONS, is_own_file, read_grasps
from ....records import GraspRecord, RunFolder, existing_source, load_grasp_task, read_grasp

__all__ = ["OwnGrasps", "foreign_grasps", "own_grasps"]


@dataclass(frozen=True)
class OwnGrasps:
    """Grasps of one run or file.

    Attributes:
        path: where they stand.
        task: what they are grasps of.
        records: the grasps.
    """

    path: Path
    task: Task
    records: Sequence[GraspRecord]

    def placed(self, object_name: str) -> list[PlacedGrasp]:
        """Them as writers take them."""
        return placed_records(self.records, self.task.hand, object_name or self.task.object.name)


def own_grasps(path: Path, *, held: bool) -> OwnGrasps | None:
    """The grasps of a run folder or of a file of ours; None for files of other programs.

    Raises:
        InputError: it can't be used, or a run has no grasp to export.
    """
    is_record = path.name == "run.json" and path.is_file()
    if path.is_dir() or is_record:
        folder = RunFolder(path.parent if is_record else path)
        run = folder.load()
        task = load_task(existing_source(run.task_source, folder.record_path))
        records = [grasp for grasp in run.grasps if (grasp.is_held if held else grasp.is_clear)]
        if not records:
            words = "no grasp is held" if held else "no grasp is clear"
            raise InputError(path, "", f"{words} of {len(run.grasps)}")
        return OwnGrasps(path, task, records)
    if not is_own_file(path):
        return None
    record = read_grasp(path)
    return OwnGrasps(path, load_grasp_task(record, path), [record])


def foreign_grasps(path: Path, arguments: argparse.Namespace) -> list[PlacedGrasp]:
    """The grasps of a file of another program; says how it is read, and what is odd in it.

    Raises:
        InputError: it can't be read, or leaves open what no reading was given for.
    """
    file = read_grasps(path)
    given = _reading(arguments.reading)
    console = Console(quiet=arguments.quiet)
    for remark in file.remarks:
        console.say(f"{path.name}: {remark}")
    usual = {question.name: question.usual for question in file.unsettled if question.usual}
    assumed = [f"{name}={answer}" for name, answer in usual.items() if name not in given]
    if assumed:
        console.say(
            f"{path.name}: {counted(len(file.grasps), 'grasp')} of {file.format}, "
            f"read with {', '.join(assumed)}"
        )
    return placed_grasps(file, file.answers(**given))


def _reading(words: Sequence[str]) -> dict[str, str]:
    reading: dict[str, str] = {}
    for word in words:
        name, _, answer = word.partition("=")
        if name not in QUESTIONS:
            raise UnknownName("--reading", "", "question", name, QUESTIONS)
        answers = next(answers for question, answers in QUESTIONS.items() if question == name)
        if answer not in answers:
            raise UnknownName("--reading", name, "answer", answer, answers)
        reading[name] = answer
    return reading
