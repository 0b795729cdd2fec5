"""Reading JSON that others wrote: bounded in size, no NaN, no key twice."""

import json
from pathlib import Path
from typing import Any

from ..errors import InputError

__all__ = ["read_json"]

# A run of thousands of grasps stays far below; anything above is not ours.
_MAX_BYTES = 256 * 1024 * 1024


def read_json(path: Path) -> dict[str, Any]:
    """Reads a JSON file that holds an object.

    Raises:
        InputError: no such file, too large, not UTF-8, not JSON (NaN is not), a key twice, or not an object.
    """
    try:
        if path.stat().st_size > _MAX_BYTES:
            raise InputError(path, "", f"larger than {_MAX_BYTES} bytes")
        text = path.read_text("utf-8")
    except UnicodeDecodeError:
        raise InputError(path, "", "not a UTF-8 text file") from None
    except OSError as error:
        raise InputError(path, "", error.strerror or "can't be read") from None
    try:
        data = json.loads(text, object_pairs_hook=_unique, parse_constant=_refuse)
    except json.JSONDecodeError as error:
        raise InputError(path, f"line {error.lineno}", f"not valid JSON: {error.msg}") from None
    except RecursionError:
        raise InputError(path, "", "nested too deeply") from None
    except ValueError as error:  # from the two hooks, and integers of thousands of digits
        raise InputError(path, "", f"not valid JSON: {error}") from None
    if not isinstance(data, dict):
        raise InputError(path, "", "must be a JSON object, such as a grasp that `holdfast run` wrote")
    return data


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for key, value in pairs:
        if key in data:
            raise ValueError(f"{key!r} stands twice")
        data[key] = value
    return data


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is not a number that JSON has")
