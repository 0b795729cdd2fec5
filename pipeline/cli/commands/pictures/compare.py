"""`holdfast compare RUN RUN`."""

import argparse
from pathlib import Path

from .....base.text.console import emit, emit_json, format_table
from .....base.text.plain_text import counted
from .....errors import InputError
from ....records import RunFolder, RunRecord
from ....report import Comparison, Row, compare_runs

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Prints in what two runs differ."""
    found = compare_runs(_loaded(arguments.first), _loaded(arguments.second))
    if arguments.json:
        emit_json(arguments.json, {"runs": [arguments.first, arguments.second], **found.as_json()})
    if arguments.json != "-":
        emit(_text(found, (arguments.first, arguments.second)))
    return 0


def _loaded(name: str) -> RunRecord:
    path = Path(name)
    if not path.is_dir():
        raise InputError(path, "", "is not a run folder")
    return RunFolder(path).load()


def _text(found: Comparison, names: tuple[str, str]) -> str:
    settings = _table("setting", names, found.settings) if found.settings else "settings: the same"
    same = f"{counted(found.same_grasps, 'grasp')} came equally far"
    grasps = f"{_table('grasp', names, found.grasps)}\n{same}" if found.grasps else same
    counts, times = _table("count", names, found.counts), _table("stage, s", names, found.times)
    return "\n\n".join([settings, counts, grasps, times]) + "\n"


def _table(head: str, names: tuple[str, str], rows: list[Row]) -> str:
    return format_table((head, *names), [(row.name, row.first, row.second) for row in rows])
