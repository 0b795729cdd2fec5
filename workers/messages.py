"""How a pool and its processes talk: whole messages over pipes, both ends of which are ours."""

import io
import pickle
import struct
from collections.abc import Sequence
from typing import IO, Any

__all__ = ["Codec", "ProcessLost", "receive", "send"]

_LENGTH = struct.Struct("<Q")


class ProcessLost(Exception):
    """The process at the other end is gone."""


class Codec:
    """Turns messages into bytes and back, without the content of what both ends have.

    Args:
        shared: these objects, in the same order at both ends.
    """

    def __init__(self, shared: Sequence[object]):
        # Held here, so that no other object can have the identity of one of them.
        self._shared = tuple(shared)
        self._places = {id(one): k for k, one in enumerate(self._shared)}

    def encode(self, message: Any) -> bytes:
        """A message as bytes."""
        buffer = io.BytesIO()
        _Pickler(buffer, self._places).dump(message)
        return buffer.getvalue()

    def decode(self, data: bytes) -> Any:
        """The message, with the objects of this end put in."""
        return _Unpickler(data, self._shared).load()


class _Pickler(pickle.Pickler):
    def __init__(self, buffer: io.BytesIO, places: dict[int, int]):
        super().__init__(buffer, protocol=pickle.HIGHEST_PROTOCOL)
        self._places = places

    def persistent_id(self, obj: Any) -> int | None:
        return self._places.get(id(obj))


class _Unpickler(pickle.Unpickler):
    def __init__(self, data: bytes, shared: tuple[object, ...]):
        super().__init__(io.BytesIO(data))
        self._shared = shared

    def persistent_load(self, pid: Any) -> object:
        return self._shared[pid]


def send(stream: IO[bytes], data: bytes) -> None:
    """Writes a message.

    Raises:
        ProcessLost: the other end is gone.
    """
    try:
        stream.write(_LENGTH.pack(len(data)) + data)
        stream.flush()
    except (OSError, ValueError):  # a pipe that is closed at this end is a ValueError
        raise ProcessLost from None


def receive(stream: IO[bytes]) -> bytes:
    """Waits for a message.

    Raises:
        ProcessLost: the other end is gone.
    """
    try:
        head = stream.read(_LENGTH.size)
        if len(head) < _LENGTH.size:
            raise ProcessLost
        (length,) = _LENGTH.unpack(head)
        data = stream.read(length)
    except (OSError, ValueError):
        raise ProcessLost from None
    if len(data) < length:
        raise ProcessLost
    return data
