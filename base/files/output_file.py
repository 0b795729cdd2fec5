"""The one door by which results are written: whole or not at all, and nothing replaced but a regular file.

Links are followed to what they name. A pipe or a character device, such as /dev/null, is written through, as
is a descriptor of this process, such as /dev/stdout. Messages name the file as the user did.
"""

import errno
import json
import os
import stat
import sys
import time
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from ...errors import InputError

__all__ = [
    "check_folder_target",
    "check_target",
    "json_text",
    "make_folder",
    "remove_parts",
    "write_bytes",
    "write_json",
    "write_text",
    "writing_file",
]

# How long a pipe may be without a reader.
_WAIT_FOR_READER_S = 10.0
_MOST_LINKS = 40


def write_bytes(path: Path, data: bytes) -> None:
    """Writes a file whole or not at all: into a temporary neighbour, then renamed.

    Raises:
        InputError: it can't be written, and why.
    """
    try:
        _write(path, data)
    except (OSError, ValueError) as error:
        raise _refused(path, _reason(error)) from None


@contextmanager
def writing_file(path: Path) -> Iterator[IO[bytes]]:
    """Writes a file piece by piece, whole or not at all: it is put in place once the block is left.

    For what is too large to be held in memory; only a regular file, or none yet, can be written so.

    Raises:
        InputError: it can't be written, and why; an `OSError` of the block counts as that, too.
    """
    try:
        target = Path(os.path.realpath(path))
        mode = _mode(target)
        if mode is not None and not stat.S_ISREG(mode):
            raise OSError(errno.EPERM, "is no regular file")
        _check_writable(target, mode)
    except (OSError, ValueError) as error:
        raise _refused(path, _reason(error)) from None
    try:
        with _replacing(target, mode) as file:
            yield file
    except OSError as error:
        raise _refused(path, _reason(error)) from None


def write_text(path: Path, text: str) -> None:
    """Writes text as UTF-8, whole or not at all.

    Raises:
        InputError: as `write_bytes`.
    """
    write_bytes(path, text.encode("utf-8"))


def write_json(path: Path, data: Any) -> None:
    """Writes JSON whole or not at all; NaN and infinity are refused.

    Raises:
        InputError: as `write_bytes`.
    """
    write_text(path, json_text(data) + "\n")


def json_text(data: Any) -> str:
    """JSON as files have it; NaN and infinity are refused.

    Raises:
        ValueError: one of them is there.
    """
    return json.dumps(data, indent=1, allow_nan=False)


def make_folder(path: Path) -> None:
    """Makes a folder and those above it, where they are missing.

    Raises:
        InputError: it can't be made, and why.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _refused(path, _reason(error)) from None


def check_target(path: Path) -> None:
    """Looks whether a result can be written to a file, before the work that leads to it; writes nothing.

    Raises:
        InputError: it can't, and why.
    """
    try:
        if _descriptor(path) is not None:
            return
        target = Path(os.path.realpath(path))
        mode = _mode(target)
        _check_writable(target, mode)
        if mode is None or stat.S_ISREG(mode):
            _check_new(target)
        elif not _is_written_through(mode):
            raise OSError(errno.EPERM, _kind(mode))
    except (OSError, ValueError) as error:
        raise _refused(path, _reason(error)) from None


def check_folder_target(path: Path) -> None:
    """Looks whether results can be written into a folder, which may be missing yet; makes nothing.

    Raises:
        InputError: they can't, and why.
    """
    try:
        # Any name will do.
        _check_new(Path(os.path.realpath(path)) / "x")
    except (OSError, ValueError) as error:
        raise _refused(path, _reason(error)) from None


def remove_parts(path: Path) -> None:
    """Removes what killed processes have left of a file; only where nobody else can be writing it."""
    with suppress(OSError):
        target = Path(os.path.realpath(path))
        for part in target.parent.glob(f"{_part_prefix(target)}*.part"):
            part.unlink(missing_ok=True)


def _write(path: Path, data: bytes) -> None:
    if (descriptor := _descriptor(path)) is not None:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        _write_all(descriptor, data)
        return
    target = Path(os.path.realpath(path))
    mode = _mode(target)
    if mode is None or stat.S_ISREG(mode):
        _check_writable(target, mode)
        _replace(target, data, mode)
    elif _is_written_through(mode):
        handle = _open_through(target)
        try:
            _write_all(handle, data)
        finally:
            os.close(handle)
    else:
        raise OSError(errno.EPERM, _kind(mode))


def _check_writable(target: Path, mode: int | None) -> None:
    """A file that was made read-only is not replaced, though its folder would allow it."""
    if mode is not None and not stat.S_ISDIR(mode) and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _replace(target: Path, data: bytes, mode: int | None) -> None:
    with _replacing(target, mode) as file:
        file.write(data)


@contextmanager
def _replacing(target: Path, mode: int | None) -> Iterator[IO[bytes]]:
    target.parent.mkdir(parents=True, exist_ok=True)
    # Short, for the name of the file may be as long as names can be.
    part = target.with_name(f"{_part_prefix(target)}{os.urandom(4).hex()}.part")
    try:
        with part.open("xb") as file:
            yield file
            file.flush()
            if mode is not None:
                os.fchmod(file.fileno(), stat.S_IMODE(mode))
            os.fsync(file.fileno())
        part.replace(target)
    except BaseException:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def _part_prefix(target: Path) -> str:
    return f".{zlib.crc32(os.fsencode(target.name)):08x}-"


def _descriptor(path: Path) -> int | None:
    """The descriptor of this process that a path stands for, as /dev/stdout does; None for other paths."""
    here = Path(path)
    for _ in range(_MOST_LINKS):
        folder = os.path.realpath(here.parent)
        if folder in (f"/proc/{os.getpid()}/fd", "/proc/self/fd") and here.name.isdecimal():
            return int(here.name)
        if not here.is_symlink():
            return None
        here = Path(folder) / os.readlink(here)
    return None


def _mode(target: Path) -> int | None:
    try:
        return target.stat().st_mode
    except FileNotFoundError:
        return None


def _is_written_through(mode: int) -> bool:
    return stat.S_ISCHR(mode) or stat.S_ISFIFO(mode)


def _kind(mode: int) -> str:
    if stat.S_ISDIR(mode):
        return "is a folder"
    return "is a socket" if stat.S_ISSOCK(mode) else "is a device that holds a file system"


def _open_through(target: Path) -> int:
    """Opens a pipe or device; a pipe must find a reader in time."""
    deadline = time.monotonic() + _WAIT_FOR_READER_S
    while True:
        try:
            handle = os.open(target, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY)
        except OSError as error:
            if error.errno != errno.ENXIO:
                raise
            if time.monotonic() > deadline:
                raise OSError(errno.ENXIO, "is a pipe that nobody reads") from None
            time.sleep(0.05)
            continue
        os.set_blocking(handle, True)
        return handle


def _write_all(handle: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(handle, view) :]


def _check_new(target: Path) -> None:
    """Whether a file can be put in place, its folders made."""
    folder = target.parent
    while (mode := _mode(folder)) is None:
        _check_length(folder)
        folder = folder.parent
    if not stat.S_ISDIR(mode):
        raise NotADirectoryError(errno.ENOTDIR, f"{folder.name!r} is not a folder")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    _check_length(target)


def _check_length(path: Path) -> None:
    if len(os.fsencode(path.name)) > 255 or len(os.fsencode(path)) > 4095:
        raise OSError(errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG))


def _reason(error: OSError | ValueError) -> str:
    if isinstance(error, ValueError):  # a null character
        return "is not the path of a file"
    if isinstance(error, (FileExistsError, NotADirectoryError)) and error.filename:
        return "part of its path is not a folder"
    text = error.strerror or str(error)
    return text[:1].lower() + text[1:]


def _refused(path: Path, reason: str) -> InputError:
    return InputError(path, "", reason if reason.startswith("is ") else f"can't be written: {reason}")
