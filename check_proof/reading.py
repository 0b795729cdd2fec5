"""Records of a proof log, and what they are made of, read with suspicion."""

import gzip
import json
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..base.files.input_file import open_input
from ..base.numeric.arrays import Array, Indices
from ..errors import InputError

__all__ = [
    "CONFIGURATIONS",
    "LOAD",
    "STATICS",
    "LogHead",
    "Rejected",
    "head_of",
    "indices",
    "items",
    "numbers",
    "records",
]


CONFIGURATIONS, STATICS, LOAD = "configurations", "statics", "load"
"""What a log refutes: configurations of a task, balance at regions of its object, or a larger load there."""

# By the key of the head that holds the version: what it is a log of, the oldest version and the newest.
# Of configurations version 3 had no cosines and sines, of the others version 1 no hand; all else is as was.
_HEADS = {
    "holdfast_proof": (CONFIGURATIONS, 3, 4),
    "holdfast_statics": (STATICS, 1, 2),
    "holdfast_load": (LOAD, 1, 2),
}
_WITH_HAND = 2
# A short text may stand for a large value: one of this length for some hundred MiB.
_LONGEST_RECORD = 1 << 24


class Rejected(Exception):
    """The log does not prove what it claims."""


class LogHead(NamedTuple):
    """What a log is about.

    Attributes:
        kind: `CONFIGURATIONS`, `STATICS` or `LOAD`.
        may_be_of_hand: whether it may be about what a hand reaches of regions; older logs of statics and of
            the load are about regions alone.
    """

    kind: str
    may_be_of_hand: bool


def records(path: Path) -> Iterator[tuple[bytes, dict[str, Any]]]:
    """The log's records, each with its line; the first is the head.

    Raises:
        InputError: the file can't be read, or is no proof log of this version.
        Rejected: the log is damaged behind its head.
    """
    is_head = True
    try:
        with open_input(path) as packed, gzip.GzipFile(fileobj=packed) as file:
            while line := file.readline(_LONGEST_RECORD):
                record = _record(line)
                if is_head:
                    _check_head(path, record)
                yield line, record
                is_head = False
    except (EOFError, gzip.BadGzipFile, zlib.error, Rejected) as error:
        if not is_head:
            raise Rejected(str(error) or "the log is damaged") from None
    if is_head:
        raise InputError(path, "", "not a proof log, as `holdfast solve --proof` writes it")


def head_of(record: dict[str, Any]) -> LogHead:
    """What the first record of a log, as `records` gives it, says that the log is about."""
    kind, version = next((kind, record[key]) for key, (kind, _, _) in _HEADS.items() if key in record)
    return LogHead(kind, kind != CONFIGURATIONS and version >= _WITH_HAND)


def _check_head(path: Path, head: dict[str, Any]) -> None:
    keys = [key for key in _HEADS if key in head]
    if len(keys) != 1 or type(version := head[keys[0]]) is not int:
        raise Rejected
    _, oldest, newest = _HEADS[keys[0]]
    if not oldest <= version <= newest:
        advice = "write it anew with this Holdfast" if version < newest else "a newer Holdfast wrote it"
        known = f"{oldest} and {newest}" if oldest < newest else f"{newest}"
        raise InputError(path, keys[0], f"version {version}, where {known} can be checked: {advice}")


def _record(line: bytes) -> dict[str, Any]:
    try:
        record = json.loads(line) if line.endswith(b"\n") else None
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict):
        raise Rejected("a record is not a line of JSON")
    return record


def numbers(data: Any, count: int | None = None) -> Array:
    """Finite numbers, as many as `count` where that is given."""
    if all(type(x) in (int, float) for x in items(data, count)):
        try:
            out = np.array(data, dtype=np.float64)
        except OverflowError:
            out = np.array([np.inf])
        if np.isfinite(out).all():
            return out
    raise Rejected("something is not a finite number")


def indices(data: Any, below: int, count: int | None = None) -> Indices:
    """Whole numbers from 0 to `below` - 1."""
    if all(type(x) is int and 0 <= x < below for x in items(data, count)):
        return np.array(data, dtype=np.int64)
    raise Rejected("an index is out of range")


def items(data: Any, count: int | None = None) -> list[Any]:
    """A list, with as many items as `count` where that is given."""
    if not isinstance(data, list) or count not in (None, len(data)):
        raise Rejected("a list is missing or has the wrong length")
    return data
