"""Pickles read as data: numpy's arrays and plain containers, and nothing else is ever made.

A pickle is a program for a small machine. Python's own reader runs what it is told to; this one runs the few
instructions that make plain values, and takes the names of numpy's constructors for what they mean without
looking any of them up.
"""

import pickletools
import warnings
from collections.abc import Callable
from io import BytesIO
from typing import Any

from .pickled_values import BUILDERS, CONSTRUCTORS, MARK, Box, Name, Refused, known_name, plain, plain_tuple

__all__ = ["read_pickle"]

# Each costs a few microseconds and, at most, some hundred bytes.
_MOST_STEPS = 6_000_000


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
    except Refused as error:
        raise ValueError(f"a pickle that {error}") from None
    except (IndexError, KeyError, TypeError, OverflowError, AttributeError, ValueError):
        raise ValueError("a damaged pickle") from None


def _run(data: bytes) -> Any:
    machine = _Machine()
    for count, (opcode, argument, _) in enumerate(pickletools.genops(BytesIO(data))):
        if count > _MOST_STEPS:
            raise Refused(f"has more than {_MOST_STEPS} instructions")
        if opcode.name == "STOP":
            return plain(machine.pop())
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
            is_made = isinstance(found, Box) and found.kind == "array" and found.is_ready
            self._stack.append(found.value if is_made else found)
        elif (act := _ACTS.get(name)) is not None:
            act(self, argument)
        elif name not in ("PROTO", "FRAME"):
            raise Refused(f"holds {name}, which numpy's arrays and plain values don't need")

    def pop(self) -> Any:
        value = self._stack.pop()
        if value is MARK:
            raise IndexError
        return value

    def _mark(self) -> int:
        """The place of the last mark."""
        place = len(self._stack) - 1
        while self._stack[place] is not MARK:
            place -= 1
            if place < 0:
                raise IndexError
        return place

    def _items(self) -> list[Any]:
        """What lies above the last mark, which goes with them."""
        place = self._mark()
        items = [plain(item) for item in self._stack[place + 1 :]]
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
        self._stack[place:] = [plain_tuple(self._stack[place + 1 :])]

    def tuple_of(self, count: int) -> None:
        items = self._stack[-count:]
        if len(items) < count or any(value is MARK for value in items):
            raise IndexError
        self._stack[-count:] = [plain_tuple(items)]

    def dict_of_items(self, _: Any) -> None:
        made: dict[Any, Any] = {}
        self._fill(made, self._items())
        self._stack.append(made)

    def append(self, _: Any) -> None:
        value = plain(self.pop())
        self._target(list).append(value)

    def append_items(self, _: Any) -> None:
        items = self._items()
        self._target(list).extend(items)

    def set_item(self, _: Any) -> None:
        value, key = plain(self.pop()), plain(self.pop())
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
                raise Refused("has a dictionary whose keys are neither text nor numbers")
            target[key.decode("utf-8", "replace") if isinstance(key, bytes) else key] = value

    def name(self, argument: Any) -> None:
        module, _, name = argument.partition(" ")
        self._stack.append(known_name(module, name))

    def name_from_stack(self, _: Any) -> None:
        name, module = self.pop(), self.pop()
        if not isinstance(name, str) or not isinstance(module, str):
            raise TypeError
        self._stack.append(known_name(module, name))

    def call(self, _: Any) -> None:
        arguments, called = self.pop(), self.pop()
        if not isinstance(called, Name) or not isinstance(arguments, tuple):
            raise TypeError
        self._stack.append(CONSTRUCTORS[called](*arguments))

    def build(self, _: Any) -> None:
        state, box = self.pop(), self.pop()
        if not isinstance(box, Box):
            raise TypeError
        if box.kind == "array" and box.is_ready:
            raise TypeError
        box.value = BUILDERS[box.kind](box.value, *_state(state))
        box.is_ready = True
        self._stack.append(box if box.kind == "dtype" else box.value)


def _state(state: Any) -> tuple[Any, ...]:
    if not isinstance(state, tuple):
        raise TypeError
    return state


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
    "MARK": lambda: MARK,
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
