"""What a pickle may hold: plain values, and numpy's arrays by the constructors that it names.

No name is ever looked up: the few that numpy's arrays need stand here for functions of our own.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["BUILDERS", "CONSTRUCTORS", "MARK", "Box", "Name", "Refused", "known_name", "plain", "plain_tuple"]

_MOST_SIDES = 8
_TYPE = re.compile(r"[<>|=]?([biufSUO])([0-9]{1,6})")


class Refused(Exception):
    """What a pickle holds that is not read."""


class _Mark:
    """Where a run of items begins on the stack."""


MARK = _Mark()


@dataclass(frozen=True)
class Name:
    """A constructor that a pickle asks for."""

    module: str
    name: str


class Box:
    """What is made in two steps: it is remembered after the first, and has its value after the second."""

    def __init__(self, kind: str, value: Any = None):
        self.kind = kind
        self.value = value
        self.is_ready = value is not None


def plain(value: Any) -> Any:
    """A value that may stand in a container: nothing half made, no bare name."""
    if isinstance(value, Box):
        if value.kind == "array" and value.is_ready:
            return value.value
        raise Refused("holds a type in the place of a value")
    if isinstance(value, Name):
        raise Refused(f"holds {value.module}.{value.name} in the place of a value")
    if value is MARK:
        raise IndexError
    if isinstance(value, tuple) and _has_parts(value):
        raise Refused("holds a type in the place of a value")
    return value


def plain_tuple(items: list[Any]) -> tuple[Any, ...]:
    """A tuple, which may hold types and names only where it is what a constructor is called with."""
    if any(isinstance(item, tuple) and _has_parts(item) for item in items):
        raise Refused("holds a type in the place of a value")
    return tuple(items)


def _has_parts(value: tuple[Any, ...]) -> bool:
    return any(isinstance(item, (Box, Name)) for item in value)


def known_name(module: str, name: str) -> Name:
    """A constructor by the name that a pickle gives it.

    Raises:
        Refused: it is none of those that numpy's arrays and plain values need.
    """
    found = Name(_MODULES.get(module, module), name)
    if found not in CONSTRUCTORS and found != _NDARRAY:
        raise Refused(f"asks for {module}.{name}; only numpy's arrays and plain values are read")
    return found


def _bytes(raw: Any) -> bytes:
    # Python 2 wrote bytes as text.
    return raw.encode("latin-1") if isinstance(raw, str) else bytes(memoryview(raw))


def _dtype(word: Any, *_: Any) -> Box:
    text = word.decode("ascii") if isinstance(word, bytes) else word
    if not isinstance(text, str) or not (found := _TYPE.fullmatch(text)):
        raise Refused("has an array of a type that is neither number nor text")
    # How large a pointer was is of no interest here.
    return Box("dtype", np.dtype("O" if found[1] == "O" else text))


def _ordered(dtype: np.dtype[Any], _version: Any, order: Any, *rest: Any) -> np.dtype[Any]:
    if rest[:3] != (None, None, None):
        raise Refused("has an array of records, which is not read")
    text = order.decode("ascii") if isinstance(order, bytes) else order
    if text not in ("<", ">", "|", "="):
        raise TypeError
    return dtype.newbyteorder(">" if text == ">" else "<") if text in "<>" else dtype


def _type_of(box: Any) -> np.dtype[Any]:
    if not isinstance(box, Box) or box.kind != "dtype":
        raise TypeError
    made: np.dtype[Any] = box.value
    return made


def _array(_: Any, _version: Any, shape: Any, dtype: Any, is_fortran: Any, content: Any) -> Any:
    return _filled(content, _type_of(dtype), shape, "F" if is_fortran else "C")


def _filled(content: Any, dtype: np.dtype[Any], shape: Any, order: str) -> Any:
    if not isinstance(shape, tuple) or len(shape) > _MOST_SIDES or any(type(n) is not int for n in shape):
        raise TypeError
    if min(shape, default=0) < 0:
        raise TypeError
    count = 1
    for side in shape:
        count *= side
    if dtype.hasobject:
        items = np.empty(len(content), dtype=object)
        for i, item in enumerate(content):
            items[i] = plain(item)
    else:
        items = np.frombuffer(_bytes(content), dtype)
    if len(items) != count:
        raise TypeError
    return items.reshape(shape, order="F" if order == "F" else "C")


def _scalar(dtype: Any, raw: Any) -> Any:
    found = _type_of(dtype)
    if found.hasobject:
        raise Refused("has a scalar that is no number")
    return np.frombuffer(_bytes(raw), found, 1)[0].item()


def _from_buffer(raw: Any, dtype: Any, shape: Any, order: Any, *_: Any) -> Any:
    return _filled(raw, _type_of(dtype), shape, order)


def _encoded(text: Any, *_: Any) -> bytes:
    return _bytes(text)


def _mapping(*items: Any) -> dict[Any, Any]:
    # The factory of a default is a name, which nobody calls.
    if items and not isinstance(items[0], (Name, type(None))):
        return dict(items[0])
    return {}


_NDARRAY = Name("numpy", "ndarray")
# Numpy 2 names its own rooms by another name, and Python 2 those of the language.
_MODULES = {
    "numpy._core.multiarray": "numpy.core.multiarray",
    "numpy._core._multiarray_umath": "numpy.core.multiarray",
    "numpy.core._multiarray_umath": "numpy.core.multiarray",
    "numpy._core.numeric": "numpy.core.numeric",
    "__builtin__": "builtins",
}
CONSTRUCTORS: dict[Name, Callable[..., Any]] = {
    Name("numpy", "dtype"): _dtype,
    Name("numpy.core.multiarray", "_reconstruct"): lambda *_: Box("array"),
    Name("numpy.core.multiarray", "scalar"): _scalar,
    Name("numpy.core.numeric", "_frombuffer"): _from_buffer,
    Name("_codecs", "encode"): _encoded,
    Name("builtins", "bytes"): lambda raw=b"", *_: _bytes(raw),
    Name("builtins", "bytearray"): lambda raw=b"", *_: _bytes(raw),
    Name("builtins", "list"): lambda items=(): list(items),
    Name("builtins", "dict"): _mapping,
    Name("collections", "OrderedDict"): _mapping,
    Name("collections", "defaultdict"): _mapping,
}
BUILDERS: dict[str, Callable[..., Any]] = {"array": _array, "dtype": _ordered}
