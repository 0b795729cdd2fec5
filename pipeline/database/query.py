"""Questions to a table, in SQL; the database sees the table's rows and nothing else of the machine."""

import datetime
import decimal
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...errors import InputError
from .extra import need
from .read import as_dataset, open_table

__all__ = ["VIEW", "Answer", "query_table"]

VIEW = "grasps"
"""Name of the table in a question."""

# What the database says before pyarrow's words where the file under the table can't be read.
_UNREADABLE = f"Invalid Input Error: reading the stream registered as '{VIEW}' failed"

# What a question could reach beside the rows; the last one keeps it from changing any of this.
_CLOSED = (
    "SET enable_external_access = false",
    "SET autoinstall_known_extensions = false",
    "SET autoload_known_extensions = false",
    "SET python_enable_replacements = false",
    "SET lock_configuration = true",
)


@dataclass(frozen=True)
class Answer:
    """The answer to a question.

    Attributes:
        names: of its columns.
        rows: its rows, as plain data.
        more: whether there are more rows than were asked for.
    """

    names: list[str]
    rows: list[tuple[Any, ...]]
    more: bool


def query_table(path: Path, sql: str, *, most: int | None = None) -> Answer:
    """Asks a Parquet table a question.

    Args:
        path: the table.
        sql: one statement, in which the table is called `grasps`.
        most: rows that are wanted at most; None for all.

    Raises:
        InputError: no such table, a damaged one, or a question that can't be answered, and why.
        MissingBackend: duckdb or pyarrow is not installed.
    """
    if path.suffix == ".jsonl":
        raise InputError(path, "", "is not a Parquet table: questions need one (extra `data`)")
    duckdb = need("duckdb", "a query")
    open_table(path)
    with duckdb.connect(":memory:") as connection:
        connection.register(VIEW, as_dataset(path))
        for setting in _CLOSED:
            connection.execute(setting)
        try:
            if len(connection.extract_statements(sql)) != 1:
                raise InputError("query", "SQL", "must be one statement")
            done = connection.execute(sql)
            names = [entry[0] for entry in done.description or ()]
            rows = done.fetchall() if most is None else done.fetchmany(most + 1)
        except duckdb.Error as error:
            words = _in_a_line(error)
            if words.startswith(_UNREADABLE):
                raise InputError(
                    path, "", f"is damaged: {words.removeprefix(_UNREADABLE).strip(' :;')}"
                ) from None
            raise InputError("query", "SQL", words) from None
    plain = [tuple(_plain(value) for value in row) for row in rows[:most]]
    return Answer(names, plain, most is not None and len(rows) > most)


def _plain(value: Any) -> Any:
    """A value as JSON has it."""
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and value - value != 0.0:  # NaN or infinite
        return None
    if isinstance(value, decimal.Decimal):
        return float(value)
    if isinstance(value, (datetime.date, datetime.time, datetime.timedelta, bytes)):
        return str(value)
    return value if value is None or isinstance(value, (bool, int, float, str)) else str(value)


def _in_a_line(error: Exception) -> str:
    """What the database complains of, without the drawing below it that points into the question."""
    return str(error).partition("\n\n")[0].replace("\n", "; ")
