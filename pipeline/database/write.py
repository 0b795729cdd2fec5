"""Tables on disk: Parquet, or JSON lines where the extra `data` is not installed."""

import json
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

from ...base.files.output_file import writing_file
from ...errors import InputError
from ..tables import arrow_schema
from .columns import COLUMNS, SCHEMA_VERSION
from .extra import need

__all__ = ["GROUP_ROWS", "MARK", "check_table_target", "write_table"]

GROUP_ROWS = 1000
"""Rows that are held in memory at a time, and of which a damage costs no more."""
MARK = b"holdfast_schema"
"""Key of the file's metadata under which the version of the schema stands."""

_SUFFIXES = (".parquet", ".jsonl")
_UNIQUE = ("record", "seal")


def check_table_target(path: Path) -> None:
    """Looks whether a table can be written under a name.

    Raises:
        InputError: another suffix than `.parquet` or `.jsonl`.
        MissingBackend: Parquet can't be written without the extra `data`.
    """
    if path.suffix not in _SUFFIXES:
        raise InputError(path, "", f"must end with {' or '.join(_SUFFIXES)}")
    if path.suffix == ".parquet":
        need("pyarrow.parquet", "a Parquet table")


def write_table(rows: Iterable[dict[str, Any]], path: Path) -> None:
    """Writes rows as a table, whole or not at all, in groups, so that memory does not grow with their number.

    Args:
        rows: as `make_row` gives them.
        path: of a `.parquet` or `.jsonl` file.

    Raises:
        InputError: it can't be written; or what the rows raise.
        MissingBackend: see `check_table_target`.
    """
    check_table_target(path)
    if path.suffix == ".jsonl":
        with writing_file(path) as file:
            for row in rows:
                file.write(json.dumps(row, allow_nan=False).encode() + b"\n")
        return
    parquet = need("pyarrow.parquet", "a Parquet table")
    arrow, schema = need("pyarrow", "a Parquet table"), _schema()
    # Dictionaries are for what repeats, which records and seals never do.
    repeating = [column.name for column in COLUMNS if column.kind == "text" and column.name not in _UNIQUE]
    options = {"compression": "zstd", "write_page_checksum": True, "use_dictionary": repeating}
    with writing_file(path) as file, parquet.ParquetWriter(file, schema, **options) as writer:
        for group in _groups(rows):
            writer.write_table(arrow.Table.from_pylist(group, schema=schema))


def _groups(rows: Iterable[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    remaining = iter(rows)
    while group := list(islice(remaining, GROUP_ROWS)):
        yield group


def _schema() -> Any:
    """The columns as Arrow has them."""
    arrow = need("pyarrow", "a Parquet table")
    schema = arrow_schema(arrow, COLUMNS, says="says", nullable=True)
    return schema.with_metadata({MARK: str(SCHEMA_VERSION).encode()})
