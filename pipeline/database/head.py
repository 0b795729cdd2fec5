"""What the rows of one run have in common."""

import json
import os
from pathlib import Path

from ...base.files.fields import Count
from ...base.files.file_model import FileModel
from ...base.files.file_paths import real_path
from ..records import RunRecord, relative_source, resolve_source
from .columns import SCHEMA_VERSION

__all__ = ["RowHead", "row_head"]


class RowHead(FileModel):
    """The columns that say what a row's grasp was made for and with; see `COLUMNS` for their meaning."""

    schema_version: int
    holdfast: str
    versions: dict[str, str]
    run: str
    task: str
    task_source: str
    task_hash: str
    hand: str
    hand_hash: str
    object: str
    object_hash: str
    seed: Count
    settings: dict[str, str]
    run_verdict: str
    run_complete: bool
    solve_verdict: str | None


def row_head(run: RunRecord, run_folder: Path, table: Path) -> RowHead:
    """The head of the rows of a run.

    Args:
        run: what `run.json` says.
        run_folder: where that lies.
        table: file that the rows are for, from whose folder paths count.
    """
    source = run.task_source and resolve_source(run.task_source, run_folder / "run.json")
    return RowHead(
        schema_version=SCHEMA_VERSION,
        holdfast=run.holdfast,
        versions={} if run.made is None else run.made.versions,
        run=os.path.relpath(real_path(run_folder), real_path(table).parent),
        task=run.task,
        task_source=relative_source(source, table),
        task_hash=run.task_fingerprint,
        hand=run.hand,
        hand_hash=run.hand_fingerprint,
        object=run.object,
        object_hash=run.object_fingerprint,
        seed=run.seed,
        settings={name: json.dumps(value) for name, value in run.settings.items()},
        run_verdict=run.verdict,
        run_complete=run.complete,
        solve_verdict=None if run.solve is None else run.solve.verdict,
    )
