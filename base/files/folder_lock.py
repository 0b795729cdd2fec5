"""A folder that one process at a time writes to."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...errors import InputError

__all__ = ["locked_folder"]


@contextmanager
def locked_folder(path: Path, what: str) -> Iterator[None]:
    """Makes a folder where there is none, and keeps other processes that ask for it out of it.

    Args:
        path: the folder.
        what: is written there, in a word, such as `run`.

    Raises:
        InputError: the folder can't be made, or another process is writing there.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        handle = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "is not the path of a folder"
        raise InputError(path, "", f"can't be used as a {what} folder: {reason}") from None
    try:
        try:
            # The lock is the kernel's, so a killed process leaves none behind.
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(path, "", f"another {what} is writing there") from None
        yield
    finally:
        os.close(handle)
