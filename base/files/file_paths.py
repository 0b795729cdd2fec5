"""Where files may lie that other files name, and where what can be made again is kept."""

import errno
import os
from pathlib import Path

import platformdirs

from ...errors import InputError

__all__ = ["cache_folder", "folders_open_to", "name_from", "real_path", "resolve_beside"]

ROOT_VARIABLE = "HOLDFAST_ROOT"
"""Environment variable with a folder below which files may name each other."""


def real_path(path: Path) -> Path:
    """The absolute path without links; of links that go round in a circle, as far as that goes.

    `Path.resolve` raises a RuntimeError there in some versions of Python; whoever opens the file is told.
    """
    return Path(os.path.realpath(path))


def resolve_beside(source: Path, relative: str, field: str, *, beside: Path | None = None) -> Path:
    """Path named inside the file `source`, which must stay where that file may look.

    Args:
        source: the file that a person gave.
        relative: the path that it names, or that a file which it names does.
        field: where it is named, for error messages.
        beside: the file from whose folder the path counts, where that is not `source`.

    Raises:
        InputError: for an absolute path, or one that leads elsewhere, be it by `..` or by a link.
    """
    try:
        target = real_path(real_path(beside or source).parent / relative)
        if target.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        folders = folders_open_to(source)
    except (OSError, ValueError):  # a circle of links, a null character
        raise InputError(source, field, f"{relative!r} is not the path of a file") from None
    if Path(relative).is_absolute() or not any(target.is_relative_to(folder) for folder in folders):
        raise InputError(
            source,
            field,
            f"{relative!r} must be a path below the folder of this file, or below the current folder or "
            f"{ROOT_VARIABLE} if this file is below it too",
        )
    return target


def name_from(folder: Path, target: Path) -> str | None:
    """The path by which a file in a folder names another one, as `resolve_beside` takes it; None for none."""
    name = Path(os.path.relpath(real_path(target), real_path(folder))).as_posix()
    try:
        resolve_beside(folder / "any", name, "")
    except InputError:
        return None
    return name


def folders_open_to(source: Path) -> list[Path]:
    """The folders below which the files named in `source` may lie.

    They are its own folder, and of the current folder and the one that $HOLDFAST_ROOT names those that it
    lies below. So a file that came from elsewhere reaches nothing of the user's; nor does one below a current
    folder that holds everything, such as the home folder.

    Raises:
        InputError: $HOLDFAST_ROOT names no folder.
    """
    own = real_path(source).parent
    try:
        current = real_path(Path.cwd())
        wider = [] if _holds_everything(current) else [current]
    except FileNotFoundError:  # it was removed
        wider = []
    if named := os.environ.get(ROOT_VARIABLE):
        if not Path(named).is_dir():
            raise InputError(ROOT_VARIABLE, "", f"there is no folder {named!r}")
        wider.append(real_path(Path(named)))
    return [own, *(folder for folder in wider if own.is_relative_to(folder))]


def _holds_everything(folder: Path) -> bool:
    """Whether a folder is the home folder, or one above it, or that of the whole file system."""
    try:
        home = real_path(Path.home())
    except RuntimeError:  # the user has none
        return folder == folder.parent
    return folder == folder.parent or home.is_relative_to(folder)


def cache_folder() -> Path:
    """Folder for what can be computed again: $HOLDFAST_CACHE, or the user's cache folder."""
    return Path(os.environ.get("HOLDFAST_CACHE") or platformdirs.user_cache_dir("holdfast"))
