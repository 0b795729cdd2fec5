"""Pickles read as data: numpy's arrays and plain containers, and nothing else is ever made.

A pickle is a program for a small machine. Python's own reader runs what it is told to; this one runs the few
instructions that make plain values, and takes the names of numpy's constructors for what they mean without
looking any of them up.
"""

import pickletools
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np

__all__ = ["read_pickle"]

# Each costs a few microseconds and, at most, some hundred bytes.
_MOST_STEPS = 6_000_000
_MOST_SIDES = 8
_TYPE = re.compile(r"[<>|=]?([biufSUO])([0-9]{1,6})")


class _Refused(Exception):
    """What a pickle holds that is not read."""


class _Mark:
    """Where a run of items begins on the stack."""


_MARK = _Mark()


@dataclass(frozen=True)
class _Name:
    """A constructor that a pickle asks for."""

    module: str
    name: str


class _Box:
    """What is made in two steps: it is remembered after the first, and has its value after the second."""

    def __init__(self, kind: str, value: Any = None):
        self.kind = kind
        self.value = value
        self.is_ready = value is not None


def read_pickle(data: bytes) -> Any:
    """The value of a pickle: None, numbers, text, bytes, lists, tuples, dictionaries and numpy arrays.

    Raises:
        ValueError: it is damaged, too long, or asks for something else, and what that is.
    """
    try:
        with warnings.catch_warnings():
            # Of escapes in text that Python 2 wrote, or damage made.
            warnings.simplefilter("ignore")
            return _run(data)
    except _Refused as error:
        raise ValueError(f"a pickle that {error}") from None
    except (IndexError, KeyError, TypeError, OverflowError, AttributeError, ValueError):
        raise ValueError("a damaged pickle") from None


def _run(data: bytes) -> Any:
    machine = _Machine()
    for count, (opcode, argument, _) in enumerate(pickletools.genops(BytesIO(data))):
        if count > _MOST_STEPS:
            raise _Refused(f"has more than {_MOST_STEPS} instructions")
        if opcode.name == "STOP":
            return _plain(machine.pop())
        machine.run(opcode.name, argument)
    raise IndexError


class _Machine:
    def __init__(self) -> None:
        self._stack: list[Any] = []
        self._memo: dict[int, Any] = {}

    def run(self, name: str, argument: Any) -> None:
        if name in _LITERALS:
            self._stack.append(argument)
        elif name in _CONSTANTS:
            self._stack.append(_CONSTANTS[name]())
        elif name in _STORE:
            self._memo[len(self._memo) if argument is None else int(argument)] = self._stack[-1]
        elif name in _FETCH:
            found = self._memo[int(argument)]
            is_made = isinstance(found, _Box) and found.kind == "array" and found.is_ready
            self._stack.append(found.value if is_made else found)
        elif (act := _ACTS.get(name)) is not None:
            act(self, argument)
        elif name not in ("PROTO", "FRAME"):
            raise _Refused(f"holds {name}, which numpy's arrays and plain values don't need")

    def pop(self) -> Any:
        value = self._stack.pop()
        if value is _MARK:
            raise IndexError
        return value

    def _mark(self) -> int:
        """The place of the last mark."""
        place = len(self._stack) - 1
        while self._stack[place] is not _MARK:
            place -= 1
            if place < 0:
                raise IndexError
        return place

    def _items(self) -> list[Any]:
        """What lies above the last mark, which goes with them."""
        place = self._mark()
        items = [_plain(item) for item in self._stack[place + 1 :]]
        del self._stack[place:]
        return items

    def drop(self, _: Any) -> None:
        self._stack.pop()

    def drop_items(self, _: Any) -> None:
        self._items()

    def twice(self, _: Any) -> None:
        self._stack.append(self._stack[-1])

    def list_of_items(self, _: Any) -> None:
        self._stack.append(self._items())

    def tuple_of_items(self, _: Any) -> None:
        place = self._mark()
        self._stack[place:] = [_tuple(self._stack[place + 1 :])]

    def tuple_of(self, count: int) -> None:
        items = self._stack[-count:]
        if len(items) < count or any(value is _MARK for value in items):
            raise IndexError
        self._stack[-count:] = [_tuple(items)]

    def dict_of_items(self, _: Any) -> None:
        made: dict[Any, Any] = {}
        self._fill(made, self._items())
        self._stack.append(made)

    def append(self, _: Any) -> None:
        value = _plain(self.pop())
        self._target(list).append(value)

    def append_items(self, _: Any) -> None:
        items = self._items()
        self._target(list).extend(items)

    def set_item(self, _: Any) -> None:
        value, key = _plain(self.pop()), _plain(self.pop())
        self._fill(self._target(dict), [key, value])

    def set_items(self, _: Any) -> None:
        items = self._items()
        self._fill(self._target(dict), items)

    def _target(self, kind: type) -> Any:
        if not isinstance(self._stack[-1], kind):
            raise TypeError
        return self._stack[-1]

    @staticmethod
    def _fill(target: dict[Any, Any], items: list[Any]) -> None:
        for key, value in zip(items[::2], items[1::2], strict=True):
            is_plain = isinstance(key, (str, int, bytes))
            if not is_plain:
                raise _Refused("has a dictionary whose keys are neither text nor numbers")
            target[key.decode("utf-8", "replace") if isinstance(key, bytes) else key] = value

    def name(self, argument: Any) -> None:
        module, _, name = argument.partition(" ")
        self._stack.append(_named(module, name))

    def name_from_stack(self, _: Any) -> None:
        name, module = self.pop(), self.pop()
        if not isinstance(name, str) or not isinstance(module, str):
            raise TypeError
        self._stack.append(_named(module, name))

    def call(self, _: Any) -> None:
        arguments, called = self.pop(), self.pop()
        if not isinstance(called, _Name) or not isinstance(arguments, tuple):
            raise TypeError
        self._stack.append(_CONSTRUCTORS[called](*arguments))

    def build(self, _: Any) -> None:
        state, box = self.pop(), self.pop()
        if not isinstance(box, _Box):
            raise TypeError
        if box.kind == "array" and box.is_ready:
            raise TypeError
        box.value = _BUILDERS[box.kind](box.value, *_state(state))
        box.is_ready = True
        self._stack.append(box if box.kind == "dtype" else box.value)


def _plain(value: Any) -> Any:
    """A value that may stand in a container: nothing half made, no bare name."""
    if isinstance(value, _Box):
        if value.kind == "array" and value.is_ready:
            return value.value
        raise _Refused("holds a type in the place of a value")
    if isinstance(value, _Name):
        raise _Refused(f"holds {value.module}.{value.name} in the place of a value")
    if value is _MARK:
        raise IndexError
    if isinstance(value, tuple) and _has_parts(value):
        raise _Refused("holds a type in the place of a value")
    return value


def _tuple(items: list[Any]) -> tuple[Any, ...]:
    """A tuple, which may hold types and names only where it is what a constructor is called with."""
    if any(isinstance(item, tuple) and _has_parts(item) for item in items):
        raise _Refused("holds a type in the place of a value")
    return tuple(items)


def _has_parts(value: tuple[Any, ...]) -> bool:
    return any(isinstance(item, (_Box, _Name)) for item in value)


def _named(module: str, name: str) -> _Name:
    found = _Name(_MODULES.get(module, module), name)
    if found not in _CONSTRUCTORS and found != _NDARRAY:
        raise _Refused(f"asks for {module}.{name}; only numpy's arrays and plain values are read")
    return found


def _state(state: Any) -> tuple[Any, ...]:
    if not isinstance(state, tuple):
        raise TypeError
    return state


def _bytes(raw: Any) -> bytes:
    # Python 2 wrote bytes as text.
    return raw.encode("latin-1") if isinstance(raw, str) else bytes(memoryview(raw))


def _dtype(word: Any, *_: Any) -> _Box:
    text = word.decode("ascii") if isinstance(word, bytes) else word
    if not isinstance(text, str) or not (found := _TYPE.fullmatch(text)):
        raise _Refused("has an array of a type that is neither number nor text")
    # How large a pointer was is of no interest here.
    return _Box("dtype", np.dtype("O" if found[1] == "O" else text))


def _ordered(dtype: np.dtype[Any], _version: Any, order: Any, *rest: Any) -> np.dtype[Any]:
    if rest[:3] != (None, None, None):
        raise _Refused("has an array of records, which is not read")
    text = order.decode("ascii") if isinstance(order, bytes) else order
    if text not in ("<", ">", "|", "="):
        raise TypeError
    return dtype.newbyteorder(">" if text == ">" else "<") if text in "<>" else dtype


def _type_of(box: Any) -> np.dtype[Any]:
    if not isinstance(box, _Box) or box.kind != "dtype":
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
            items[i] = _plain(item)
    else:
        items = np.frombuffer(_bytes(content), dtype)
    if len(items) != count:
        raise TypeError
    return items.reshape(shape, order="F" if order == "F" else "C")


def _scalar(dtype: Any, raw: Any) -> Any:
    found = _type_of(dtype)
    if found.hasobject:
        raise _Refused("has a scalar that is no number")
    return np.frombuffer(_bytes(raw), found, 1)[0].item()


def _from_buffer(raw: Any, dtype: Any, shape: Any, order: Any, *_: Any) -> Any:
    return _filled(raw, _type_of(dtype), shape, order)


def _encoded(text: Any, *_: Any) -> bytes:
    return _bytes(text)


def _mapping(*items: Any) -> dict[Any, Any]:
    # The factory of a default is a name, which nobody calls.
    if items and not isinstance(items[0], (_Name, type(None))):
        return dict(items[0])
    return {}


_NDARRAY = _Name("numpy", "ndarray")
# Numpy 2 names its own rooms by another name, and Python 2 those of the language.
_MODULES = {
    "numpy._core.multiarray": "numpy.core.multiarray",
    "numpy._core._multiarray_umath": "numpy.core.multiarray",
    "numpy.core._multiarray_umath": "numpy.core.multiarray",
    "numpy._core.numeric": "numpy.core.numeric",
    "__builtin__": "builtins",
}
_CONSTRUCTORS: dict[_Name, Callable[..., Any]] = {
    _Name("numpy", "dtype"): _dtype,
    _Name("numpy.core.multiarray", "_reconstruct"): lambda *_: _Box("array"),
    _Name("numpy.core.multiarray", "scalar"): _scalar,
    _Name("numpy.core.numeric", "_frombuffer"): _from_buffer,
    _Name("_codecs", "encode"): _encoded,
    _Name("builtins", "bytes"): lambda raw=b"", *_: _bytes(raw),
    _Name("builtins", "bytearray"): lambda raw=b"", *_: _bytes(raw),
    _Name("builtins", "list"): lambda items=(): list(items),
    _Name("builtins", "dict"): _mapping,
    _Name("collections", "OrderedDict"): _mapping,
    _Name("collections", "defaultdict"): _mapping,
}
_BUILDERS: dict[str, Callable[..., Any]] = {"array": _array, "dtype": _ordered}
_TEXTS = (
    *("STRING", "BINSTRING", "SHORT_BINSTRING"),
    *("UNICODE", "BINUNICODE", "SHORT_BINUNICODE", "BINUNICODE8"),
)
_BYTES = ("BINBYTES", "SHORT_BINBYTES", "BINBYTES8", "BYTEARRAY8")
_NUMBERS = ("INT", "BININT", "BININT1", "BININT2", "LONG", "LONG1", "LONG4", "FLOAT", "BINFLOAT")
_LITERALS = frozenset((*_TEXTS, *_BYTES, *_NUMBERS))
_CONSTANTS: dict[str, Callable[[], Any]] = {
    "NONE": lambda: None,
    "NEWTRUE": lambda: True,
    "NEWFALSE": lambda: False,
    "EMPTY_LIST": list,
    "EMPTY_DICT": dict,
    "EMPTY_TUPLE": tuple,
    "MARK": lambda: _MARK,
}
_STORE = frozenset(("PUT", "BINPUT", "LONG_BINPUT", "MEMOIZE"))
_FETCH = frozenset(("GET", "BINGET", "LONG_BINGET"))
_ACTS: dict[str, Callable[[_Machine, Any], None]] = {
    "POP": _Machine.drop,
    "POP_MARK": _Machine.drop_items,
    "DUP": _Machine.twice,
    "LIST": _Machine.list_of_items,
    "TUPLE": _Machine.tuple_of_items,
    "DICT": _Machine.dict_of_items,
    "TUPLE1": lambda machine, _: machine.tuple_of(1),
    "TUPLE2": lambda machine, _: machine.tuple_of(2),
    "TUPLE3": lambda machine, _: machine.tuple_of(3),
    "APPEND": _Machine.append,
    "APPENDS": _Machine.append_items,
    "SETITEM": _Machine.set_item,
    "SETITEMS": _Machine.set_items,
    "GLOBAL": _Machine.name,
    "STACK_GLOBAL": _Machine.name_from_stack,
    "REDUCE": _Machine.call,
    "BUILD": _Machine.build,
}
