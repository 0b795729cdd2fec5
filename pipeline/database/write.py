"""Tables on disk: Parquet, or JSON lines where the extra `data` is not installed."""

import json
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files import writing_file
from .columns import COLUMNS, SCHEMA_VERSION, Kind
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
    arrow, schema = need("pyarrow", "a Parquet table"), arrow_schema()
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


def arrow_schema() -> Any:
    """The columns as Arrow has them."""
    arrow = need("pyarrow", "a Parquet table")
    fields = [
        arrow.field(column.name, _arrow_type(column.kind), metadata={"says": column.says})
        for column in COLUMNS
    ]
    return arrow.schema(fields, metadata={MARK: str(SCHEMA_VERSION).encode()})


def _arrow_type(kind: Kind) -> Any:
    arrow = need("pyarrow", "a Parquet table")
    text, number, numbers = arrow.string(), arrow.float64(), arrow.list_(arrow.float64())
    contact = {
        "hand": text,
        "object": text,
        "point_m": numbers,
        "normal": numbers,
        "gap_m": number,
        "region_gap_m": number,
        "normal_angle_rad": number,
        "opposed_within_deg": number,
    }
    direction = {
        "gravity_m_s2": numbers,
        "held": arrow.bool_(),
        "outcome": text,
        "slip_m": number,
        "turn_rad": number,
    }
    return {
        "text": text,
        "texts": arrow.list_(text),
        "whole": arrow.int64(),
        "number": number,
        "numbers": numbers,
        "truth": arrow.bool_(),
        "numbers by name": arrow.map_(text, number),
        "texts by name": arrow.map_(text, text),
        "contacts": arrow.list_(arrow.struct(list(contact.items()))),
        "directions": arrow.list_(arrow.struct(list(direction.items()))),
    }[kind]
