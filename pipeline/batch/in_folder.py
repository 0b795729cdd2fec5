"""The tasks and meshes that lie in a folder."""

from pathlib import Path
from typing import NamedTuple

from ...base.files.library import FILE_SUFFIXES
from ...base.files.yaml_file import read_yaml
from ...errors import InputError
from ...objects import MESH_FORMATS, looks_like_mesh

__all__ = ["MESHES", "TASK_FILES", "InFolder", "in_folder"]

TASK_FILES = f"task file ({' or '.join(FILE_SUFFIXES)})"
MESHES = f"mesh ({', '.join(MESH_FORMATS)})"
"""What a batch takes, in words."""

# Names of files that are told of at most.
_SHOWN = 4


class InFolder(NamedTuple):
    """What lies in a folder, by name.

    Attributes:
        references: paths of its task files and meshes.
        others: names of what is neither, hidden files aside.
    """

    references: list[str]
    others: list[str]

    def __str__(self) -> str:
        more = f" and {len(self.others) - _SHOWN} more" if len(self.others) > _SHOWN else ""
        return f"{', '.join(self.others[:_SHOWN])}{more}" if self.others else "nothing"


def in_folder(folder: Path) -> InFolder:
    """The task files and meshes of a folder; those of folders in it are none of its own.

    Raises:
        InputError: it can't be read, or holds none.
    """
    try:
        paths = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
    except OSError as error:
        raise InputError(folder, "", f"can't be read: {error.strerror}") from None
    wanted = [path for path in paths if path.is_file() and (looks_like_mesh(path.name) or _is_task(path))]
    others = [f"{path.name}/" if path.is_dir() else path.name for path in paths if path not in wanted]
    found = InFolder([str(path) for path in wanted], others)
    if not wanted:
        raise InputError(folder, "", f"is a folder with no {TASK_FILES} and no {MESHES}; it holds {found}")
    return found


def _is_task(path: Path) -> bool:
    """Whether a file is a task, or may be one that somebody has made a slip in."""
    if path.suffix.lower() not in FILE_SUFFIXES:
        return False
    try:
        fields = read_yaml(path)
    except InputError:
        return True
    return "contacts" in fields
