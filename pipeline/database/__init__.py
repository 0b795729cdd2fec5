"""Runs as one table of grasps: written, read with its damages named, replayed, asked questions."""

from .collect import Collected, find_runs
from .columns import COLUMNS, SCHEMA_VERSION
from .croissant import croissant
from .extra import has_parquet
from .query import Answer, query_table
from .read import checked_rows, find_row
from .replay import Finding, Replay, replay_row
from .row import Row
from .write import check_table_target, write_table

__all__ = [
    "COLUMNS",
    "SCHEMA_VERSION",
    "Answer",
    "Collected",
    "Finding",
    "Replay",
    "Row",
    "check_table_target",
    "checked_rows",
    "croissant",
    "find_row",
    "find_runs",
    "has_parquet",
    "query_table",
    "replay_row",
    "write_table",
]
