"""How a search and its worker processes talk: whole messages over pipes, both ends of which are ours."""

import io
import pickle
import struct
from typing import IO, Any

from ..objects import Task

__all__ = ["WorkerLost", "decode", "encode", "receive", "send"]

_LENGTH = struct.Struct("<Q")


class WorkerLost(Exception):
    """The process at the other end is gone."""


class _Pickler(pickle.Pickler):
    """Leaves the task out of each configuration: both ends have it, and it holds whole meshes."""

    def persistent_id(self, obj: Any) -> str | None:
        return "task" if isinstance(obj, Task) else None


class _Unpickler(pickle.Unpickler):
    def __init__(self, data: bytes, task: Task | None):
        super().__init__(io.BytesIO(data))
        self._task = task

    def persistent_load(self, pid: Any) -> Task | None:
        return self._task


def encode(message: Any) -> bytes:
    """A message as bytes, without the task."""
    buffer = io.BytesIO()
    _Pickler(buffer, protocol=pickle.HIGHEST_PROTOCOL).dump(message)
    return buffer.getvalue()


def decode(data: bytes, task: Task | None) -> Any:
    """The message, with `task` put back in."""
    return _Unpickler(data, task).load()


def send(stream: IO[bytes], data: bytes) -> None:
    """Writes a message.

    Raises:
        WorkerLost: the other end is gone.
    """
    try:
        stream.write(_LENGTH.pack(len(data)) + data)
        stream.flush()
    except (OSError, ValueError):
        raise WorkerLost from None


def receive(stream: IO[bytes]) -> bytes:
    """Waits for a message.

    Raises:
        WorkerLost: the other end is gone.
    """
    try:
        head = stream.read(_LENGTH.size)
        if len(head) < _LENGTH.size:
            raise WorkerLost
        (length,) = _LENGTH.unpack(head)
        data = stream.read(length)
    except (OSError, ValueError):
        raise WorkerLost from None
    if len(data) < length:
        raise WorkerLost
    return data
