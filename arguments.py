"""Checks of arguments: what can't be used is an `InputError` that names the argument and what is allowed."""

import math
import os
import reprlib
from numbers import Integral, Real
from pathlib import Path
from typing import TypeVar

from .errors import InputError

__all__ = [
    "check_budget",
    "check_instance",
    "check_name_or_path",
    "check_number",
    "check_path",
    "check_whole_number",
    "number_or_nan",
]

KindT = TypeVar("KindT")


def check_number(
    name: str, value: object, *, above: float | None = None, least: float | None = None
) -> float:
    """A finite number.

    Args:
        name: of the argument.
        value: what was given for it.
        above: it must be larger than this.
        least: it must not be smaller than this.

    Raises:
        InputError: it is no finite number, or too small.
    """
    allowed = "must be a finite number"
    if above is not None:
        allowed += f" above {above:g}"
    if least is not None:
        allowed += f" of at least {least:g}"
    number = number_or_nan(value)
    if not math.isfinite(number) or _too_small(number, above, least):
        raise InputError(name, "", f"{allowed}, not {_shown(value)}")
    return number


def check_budget(name: str, value: object) -> float:
    """A time in s: a number of at least 0, or infinity for no limit.

    Raises:
        InputError: it is no number, is nan, or negative.
    """
    number = number_or_nan(value)
    if not number >= 0.0:  # nan fails too
        raise InputError(name, "", f"must be a number of seconds of at least 0, or inf, not {_shown(value)}")
    return number


def check_whole_number(name: str, value: object, *, least: int) -> int:
    """A whole number (`int`, or one of numpy's) of at least `least`.

    Raises:
        InputError: it is no whole number, or too small.
    """
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise InputError(name, "", f"must be a whole number of at least {least}, not {_shown(value)}")
    return int(value)


def check_instance(name: str, value: object, kind: type[KindT], allowed: str) -> KindT:
    """A value of the given type.

    Args:
        name: of the argument.
        value: what was given for it.
        kind: the type.
        allowed: what it is, for people, such as `a Task, as load_task gives it`.

    Raises:
        InputError: it is something else.
    """
    if not isinstance(value, kind):
        raise InputError(name, "", f"must be {allowed}, not {_shown(value)}")
    return value


def check_path(name: str, value: object) -> Path:
    """The path of a file or folder: text that is not empty, or what stands for it, as `pathlib.Path` does.

    Raises:
        InputError: it is something else.
    """
    path = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(path, str) or not path:
        raise InputError(name, "", f"must be a path, as text or pathlib.Path, not {_shown(value)}")
    return Path(path)


def check_name_or_path(
    value: object, source: str, field: str, allowed: str = "must be a name or a path"
) -> str:
    """A name, or a path, as text.

    Args:
        value: what was given.
        source: what asked for it, for the error message.
        field: field of `source` that holds it.
        allowed: what it is, for people.

    Raises:
        InputError: it is neither text nor a path.
    """
    text = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(text, str):
        raise InputError(source, field, f"{allowed}, not {_shown(value)}")
    return text


def number_or_nan(value: object) -> float:
    """A number of whatever type as a float; nan for what is none, or beyond them."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return math.nan
    try:
        return float(value)
    except OverflowError:  # a whole number of hundreds of digits
        return math.nan


def _too_small(number: float, above: float | None, least: float | None) -> bool:
    return (above is not None and number <= above) or (least is not None and number < least)


def _shown(value: object) -> str:
    """The value in a few words; numbers as they are written, whatever their type."""
    return f"{value}" if isinstance(value, Real) else reprlib.repr(value)
