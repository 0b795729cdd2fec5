"""`holdfast report RUN`."""

import argparse
from pathlib import Path

from ...errors import InputError
from ..output import emit

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Writes the report of a run anew from what lies in its folder."""
    from ...objects import load_task
    from ..grasps import resolve_source
    from ..report import write_report
    from ..run_folder import RunFolder

    path = Path(arguments.run)
    if not path.is_dir():
        raise InputError(path, "", "is not a run folder")
    folder = RunFolder(path)
    record = folder.load()
    task = load_task(resolve_source(record.task_source, folder.record_path))
    out = Path(arguments.out) if arguments.out else folder.report_path
    write_report(task, record, folder, out)
    emit(str(out))
    return 0
