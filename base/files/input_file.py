"""The one door by which files of others are opened: regular files only, no more of them than is allowed.

Whatever a path leads to, nothing here waits: a pipe, a device or a folder is refused before it is opened. No
size that the file system states is relied on, for a file may grow and some have none.
"""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from ...errors import InputError

__all__ = ["open_input", "read_input", "read_text"]

# What stands in a repository for a large file until it is fetched (git-lfs.com, its specification).
_POINTER = b"version https://git-lfs.github.com/spec/"
_CHUNK_BYTES = 1 << 20
_MIB = 1 << 20


@contextmanager
def open_input(
    path: Path, *, source: str | Path = "", field: str = "", links: bool = True
) -> Iterator[BinaryIO]:
    """Opens a regular file to read bytes from.

    Args:
        path: the file.
        source: what names it, for messages; the file itself unless given.
        field: where in `source`.
        links: whether the file may be a link.

    Raises:
        InputError: there is no such file, it is none, or it can't be read; also where that turns out later.
            Or it is what a repository has in place of a file that lies elsewhere (Git LFS).
    """

    def refused(reason: str) -> InputError:
        return (
            InputError(source, field, f"{path.name!r}: {reason}") if source else InputError(path, "", reason)
        )

    if "\0" in str(path):
        raise refused("is not the path of a file")
    try:
        # A device may act on being opened, so it is not; a pipe that took the file's place can't hold us up.
        if not stat.S_ISREG(os.stat(path, follow_symlinks=links).st_mode):
            raise refused("is not a regular file")
        flags = os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | (0 if links else os.O_NOFOLLOW)
        with open(os.open(path, flags), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise refused("is not a regular file")
            if file.read(len(_POINTER)) == _POINTER:
                raise refused("stands for a file that Git LFS keeps; `git lfs pull` fetches it")
            file.seek(0)
            yield file
    except OSError as error:
        if error.errno is None:  # what a reader says of the content, not the system of the file
            raise
        raise refused((error.strerror or "can't be read").lower()) from None


def read_input(
    path: Path, largest: int, *, source: str | Path = "", field: str = "", links: bool = True
) -> bytes:
    """The bytes of a regular file, which may be `largest` at most.

    Raises:
        InputError: as `open_input`, or there are more.
    """
    data = bytearray()
    with open_input(path, source=source, field=field, links=links) as file:
        while chunk := file.read(min(_CHUNK_BYTES, largest + 1 - len(data))):
            data += chunk
    if len(data) > largest:
        size = f"{largest // _MIB} MiB" if largest >= _MIB else f"{largest} bytes"
        name = f"{path.name!r} is " if source else ""
        raise InputError(source or path, field, f"{name}larger than {size}")
    return bytes(data)


def read_text(path: Path, largest: int) -> str:
    """The text of a regular file in UTF-8, with or without the mark at its beginning.

    Raises:
        InputError: as `read_input`, or it is no such text.
    """
    try:
        return read_input(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(path, "", "not a UTF-8 text file") from None
