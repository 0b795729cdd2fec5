"""`holdfast report RUN`."""

import argparse
from pathlib import Path

from .....base.text.console import emit
from .....errors import InputError
from .....objects import load_task
from ....records import RunFolder, existing_source
from ....report import write_report

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Writes the report of a run anew from what lies in its folder."""
    path = Path(arguments.run)
    if not path.is_dir():
        raise InputError(path, "", "is not a run folder")
    folder = RunFolder(path)
    record = folder.load()
    task = load_task(existing_source(record.task_source, folder.record_path))
    out = Path(arguments.out) if arguments.out else folder.report_path
    write_report(task, record, folder, out)
    emit(str(out))
    return 0
