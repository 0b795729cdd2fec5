"""Reading JSON: no more of it than is sane, numbers finite, no key twice."""

import json
from pathlib import Path
from typing import Any

from ...errors import InputError
from .input_file import read_text

__all__ = ["read_json", "read_json_value"]

# A run of thousands of grasps stays far below; a larger JSON file is not ours.
_LARGEST_JSON_BYTES = 128 * 1024 * 1024
# A value takes some 100 bytes once it is read, however short it is written.
_MOST_JSON_VALUES = 6_000_000


def read_json(path: Path) -> dict[str, Any]:
    """Reads a JSON file that holds an object.

    Raises:
        InputError: no such file, too large, not UTF-8, not JSON (NaN is not), a key twice, or not an object.
    """
    data = read_json_value(path)
    if not isinstance(data, dict):
        raise InputError(path, "", "must be a JSON object")
    return data


def read_json_value(path: Path, *, not_numbers: bool = False) -> Any:
    """Reads a JSON file, whatever value it holds.

    Args:
        path: the file.
        not_numbers: whether NaN and Infinity are read, as Python writes them, for a reader that refuses them
            where they matter.

    Raises:
        InputError: no such file, too large, not UTF-8, not JSON, or a key twice.
    """
    text = read_text(path, _LARGEST_JSON_BYTES)
    if sum(map(text.count, "[{,")) > _MOST_JSON_VALUES:
        raise InputError(path, "", f"holds more than {_MOST_JSON_VALUES} values")
    if not text.strip():
        raise InputError(path, "", "is empty, and no JSON")
    constant = float if not_numbers else _refuse
    try:
        return json.loads(text, object_pairs_hook=_unique, parse_constant=constant)
    except json.JSONDecodeError as error:
        raise InputError(path, f"line {error.lineno}", f"not valid JSON: {error.msg}") from None
    except RecursionError:
        raise InputError(path, "", "nested too deeply") from None
    except ValueError as error:  # from the two hooks, and integers of thousands of digits
        raise InputError(path, "", f"not valid JSON: {error}") from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for key, value in pairs:
        if key in data:
            raise ValueError(f"{key!r} stands twice")
        data[key] = value
    return data


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is not a number that JSON has")
