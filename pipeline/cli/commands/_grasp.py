"""What the commands on a single grasp file share."""

import argparse
from dataclasses import dataclass
from pathlib import Path

from ....base.files.output_file import write_json
from ....base.text.console import Console, emit, emit_json
from ....errors import InputError
from ....solver import Configuration
from ...records import (
    GraspFile,
    existing_source,
    fingerprint,
    load_grasp_task,
    read_grasp,
    relative_source,
    to_configuration,
    to_json,
    updated,
)

__all__ = ["Loaded", "finish", "load", "load_grasp"]


@dataclass(frozen=True, eq=False)
class Loaded:
    """A grasp file with what it describes."""

    path: Path
    record: GraspFile
    configuration: Configuration


def load(arguments: argparse.Namespace) -> Loaded:
    """Reads the grasp file that was named, and its task.

    Raises:
        InputError: either can't be used.
    """
    return load_grasp(Path(arguments.grasp), arguments.task)


def load_grasp(path: Path, task_name: str | None) -> Loaded:
    """Reads a grasp file, and its task or the one that is named instead.

    Raises:
        InputError: either can't be used.
    """
    if path.is_dir():
        raise InputError(path, "", "is a folder: name a grasp file, such as one in its grasps/")
    record = read_grasp(path)
    task = load_grasp_task(record, path, task_name)
    if record.task_fingerprint not in ("", fingerprint(task)):
        Console().say(f"note: task {task.name} is not quite the one that {path.name} was made for")
    return Loaded(path, record, to_configuration(record, task, path))


def finish(arguments: argparse.Namespace, record: GraspFile, line: str) -> None:
    """Writes the grasp where it was asked for, and the line unless stdout is taken."""
    if arguments.out:
        write_json(Path(arguments.out), to_json(_moved(record, arguments, Path(arguments.out))))
    if arguments.json:
        emit_json(arguments.json, to_json(record))
    if arguments.json != "-":
        emit(line)


def _moved(record: GraspFile, arguments: argparse.Namespace, out: Path) -> GraspFile:
    """The record as it is written elsewhere: its task's file is named from there."""
    if not (arguments.task or record.task_source):
        return record
    reference = arguments.task or existing_source(record.task_source, Path(arguments.grasp))
    return updated(record, task_source=relative_source(reference, out))
