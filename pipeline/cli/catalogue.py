"""What is built in, listed from the head of each file, without loading geometry."""

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from ...base.files.input_file import read_text
from ...base.files.library import FILE_SUFFIXES
from ...base.files.yaml_file import read_yaml
from ...errors import UnknownName

__all__ = ["KINDS", "Entry", "entries", "find_entry", "head_comment"]

_LARGEST_BYTES = 4 * 1024 * 1024

KINDS = {"task": ("objects", "data", "tasks"), "object": ("objects", "data"), "hand": ("hands", "data")}
"""Folder of the package in which the files of each kind lie."""


@dataclass(frozen=True)
class Entry:
    """A built-in task, object or hand.

    Attributes:
        name: what it is called on the command line.
        description: its line for people.
        path: its file.
    """

    name: str
    description: str
    path: Path


def entries(kind: str) -> list[Entry]:
    """Built-in things of a kind (a key of `KINDS`), sorted by name."""
    # Through the root package: asking for files of `holdfast.objects` would import it, which takes a second.
    folder = Path(str(files("holdfast"))).joinpath(*KINDS[kind])
    paths = folder.rglob("*.yaml") if kind == "task" else folder.glob("*.yaml")
    return [
        Entry(str(path.relative_to(folder).with_suffix("")), read_yaml(path).get("description", ""), path)
        for path in sorted(paths)
    ]


def find_entry(kind: str, name: str) -> Entry:
    """The built-in thing called `name`.

    Raises:
        UnknownName: there is none.
    """
    known = {entry.name: entry for entry in entries(kind)}
    if name not in known:
        raise UnknownName(kind, "", kind, name, known)
    return known[name]


def head_comment(path: Path) -> str:
    """The comment at the top of a file of a hand, where it says what its numbers come from."""
    lines = []
    if path.suffix.lower() not in FILE_SUFFIXES:
        return ""
    for line in read_text(path, _LARGEST_BYTES).splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").strip())
    return "\n".join(lines)
