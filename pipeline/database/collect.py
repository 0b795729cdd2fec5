"""The rows of run folders, wherever they lie; what can't be read is named and left out."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...errors import InputError
from ..records import RunFolder
from .head import row_head
from .row import make_row

__all__ = ["Collected", "find_runs"]


def find_runs(path: Path) -> list[Path]:
    """The run folders at a path: itself, or those below it, sorted; links are not followed.

    Raises:
        InputError: there is no folder, or none that holds a `run.json`.
    """
    if path.name == "run.json" and path.is_file():
        path = path.parent
    if not path.is_dir():
        raise InputError(path, "", "is no run folder: there is no such folder")
    found = []
    for folder, inner, files in os.walk(path):
        # What a batch has set aside as damaged is no longer its own.
        aside = ("damaged",) if "batch.json" in files else ()
        inner[:] = sorted(name for name in inner if not name.startswith(".") and name not in aside)
        if "run.json" in files:
            inner.clear()
            found.append(Path(folder))
    if not found:
        raise InputError(path, "", "holds no run: neither a run.json nor folders with one")
    return found


@dataclass
class Collected:
    """Rows of runs, one after the other; iterate over it once.

    Attributes:
        paths: run folders, or folders that hold some.
        table: the file that the rows are for.
        runs: run folders that were read so far.
        rows: rows that were given so far.
        refused: what could not be read, in words that name the file.
    """

    paths: Sequence[Path]
    table: Path
    runs: int = 0
    rows: int = 0
    refused: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """The rows, in the order of the paths, each run's best grasp first.

        Raises:
            InputError: a path that holds no run.
        """
        for folder in dict.fromkeys(run for path in self.paths for run in find_runs(path)):
            try:
                run = RunFolder(folder).load()
                head = row_head(run, folder, self.table)
            except InputError as error:
                self.refused.append(str(error))
                continue
            self.runs += 1
            for grasp in run.grasps:
                yield make_row(self.rows, head, grasp)
                self.rows += 1
