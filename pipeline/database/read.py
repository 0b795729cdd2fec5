"""Tables read again: one row, or all with what is damaged named."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...errors import InputError
from .columns import COLUMNS, SCHEMA_VERSION
from .extra import need
from .row import Row, read_row
from .write import MARK

__all__ = ["checked_rows", "find_row", "open_table"]

_LONGEST_LINE = 16 * 1024 * 1024
_MAPS = tuple(column.name for column in COLUMNS if column.kind.endswith("by name"))


def open_table(path: Path) -> Any:
    """A Parquet table that this version can read; page checksums are verified as it is read.

    Raises:
        InputError: no such file, no table of this kind, or one of another schema version.
        MissingBackend: pyarrow is not installed.
    """
    parquet, arrow = need("pyarrow.parquet", "a Parquet table"), need("pyarrow", "a Parquet table")
    _require_file(path)
    try:
        file = parquet.ParquetFile(path, page_checksum_verification=True)
    except (arrow.ArrowException, OSError) as error:
        raise InputError(path, "", f"is no Parquet file, or damaged: {_first_line(error)}") from None
    found = (file.schema_arrow.metadata or {}).get(MARK)
    if found is None:
        raise InputError(path, "", "is no table of grasps: write one by `holdfast table`")
    if found != str(SCHEMA_VERSION).encode():
        version = found.decode("utf-8", "replace")[:20]
        raise InputError(path, "", f"has schema version {version}; this reads {SCHEMA_VERSION}")
    return file


def find_row(path: Path, number: int) -> Row:
    """The row with this number.

    Raises:
        InputError: there is none, or it is damaged; and see `open_table`.
    """
    if path.suffix == ".jsonl":
        found = [data for data in _lines(path) if isinstance(data, dict) and data.get("row") == number]
    else:
        dataset, arrow = need("pyarrow.dataset", "a Parquet table"), need("pyarrow", "a Parquet table")
        open_table(path)
        try:
            table = as_dataset(path).to_table(filter=dataset.field("row") == number)
        except (arrow.ArrowException, OSError) as error:
            raise InputError(path, f"row {number}", f"can't be read: {_first_line(error)}") from None
        found = _plain(table)
    if len(found) != 1:
        what = "there is no such row" if not found else f"stands {len(found)} times"
        raise InputError(path, f"row {number}", what)
    return read_row(found[0], path)


def checked_rows(path: Path) -> Iterator[Row | str]:
    """Every row of a table: itself where it is whole, else what is wrong with it, in words.

    Raises:
        InputError: see `open_table`.
    """
    groups = ([line] for line in _lines(path)) if path.suffix == ".jsonl" else _groups(path)
    for group in groups:
        if isinstance(group, str):
            yield group
            continue
        for data in group:
            try:
                if isinstance(data, str):
                    raise InputError(path, data, "is not a JSON object")
                yield read_row(data, path)
            except InputError as error:
                yield str(error)


def as_dataset(path: Path) -> Any:
    """A Parquet table to be scanned, page checksums verified."""
    dataset = need("pyarrow.dataset", "a Parquet table")
    options = dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
    return dataset.dataset(path, format=dataset.ParquetFileFormat(default_fragment_scan_options=options))


def _groups(path: Path) -> Iterator[list[dict[str, Any]] | str]:
    arrow, file, first = need("pyarrow", "a Parquet table"), open_table(path), 0
    for k in range(file.num_row_groups):
        count = file.metadata.row_group(k).num_rows
        try:
            yield _plain(file.read_row_group(k))
        except (arrow.ArrowException, OSError) as error:
            last = first + count - 1
            yield f"{path}: rows {first} to {last} of the file: can't be read: {_first_line(error)}"
        first += count


def _plain(table: Any) -> list[dict[str, Any]]:
    """Rows as they were handed to Arrow, which gives what is kept by name as pairs."""
    rows: list[dict[str, Any]] = table.to_pylist()
    for row in rows:
        for name in _MAPS:
            if row.get(name) is not None:
                row[name] = dict(row[name])
    return rows


def _lines(path: Path) -> Iterator[dict[str, Any] | str]:
    """Lines as objects; the number of one that is none, in words."""
    _require_file(path)
    with path.open("rb") as file:
        number = 0
        while line := file.readline(_LONGEST_LINE):
            number += 1
            try:
                data = json.loads(line)
            except (ValueError, RecursionError):
                data = None
            yield data if isinstance(data, dict) else f"line {number}"


def _require_file(path: Path) -> None:
    if not path.is_file():
        raise InputError(path, "", "there is no such file" if not path.exists() else "is no file")


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0]
