"""What a batch runs: tasks and meshes by the names that `holdfast run` takes, and rows of family members."""

import os
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ...base.files.input_file import read_text
from ...errors import InputError
from ...hands import HAND_SUFFIXES
from ...objects import builtin_tasks, looks_like_mesh, split_reference, with_hand
from ..run import folder_name
from .in_folder import InFolder, in_folder

__all__ = ["Item", "items_of", "read_list"]

_MOST_ITEMS = 1_000_000
_LARGEST_LIST_BYTES = 64 * 1024 * 1024
_ROW_OF_MEMBERS = re.compile(r"(family:[a-z]+:)([0-9]{1,10})-([0-9]{1,10})(@.*)?")


@dataclass(frozen=True)
class Item:
    """One thing to run.

    Attributes:
        reference: a task or a mesh, as `holdfast run` takes it; files by their absolute paths, for a worker
            may have another current folder.
        name: of its folder and its outcome; no other item has it.
    """

    reference: str
    name: str

    @property
    def is_mesh(self) -> bool:
        """Whether it is a mesh file, for which contacts are looked for."""
        return looks_like_mesh(self.reference)


def items_of(
    references: Iterable[str],
    hand: str | None = None,
    *,
    on_folder: Callable[[str, InFolder], None] = lambda _, __: None,
) -> list[Item]:
    """The items that words name, each once, in their order.

    Args:
        references: tasks, meshes, folders of these, and rows such as `family:mug:0-99`.
        hand: takes the place of the tasks' own, and of a mesh's usual one.
        on_folder: called with each folder, and what lies in it.

    Raises:
        InputError: none, too many, a row that ends before it begins, or a folder without tasks and meshes.
    """
    names: dict[str, str] = {}
    taken: dict[str, int] = {}
    for reference in _each(references, on_folder):
        asked = _absolute(reference, hand)
        if asked in names:
            continue
        if len(names) == _MOST_ITEMS:
            raise InputError("batch", "TASKS", f"are more than {_MOST_ITEMS}")
        plain = folder_name(_without_folders(asked))
        taken[plain] = taken.get(plain, 0) + 1
        # No plain name has a dot, so none is met twice.
        names[asked] = plain if taken[plain] == 1 else f"{plain}.{taken[plain]}"
    if not names:
        raise InputError("batch", "TASKS", "names no task")
    return [Item(reference, name) for reference, name in names.items()]


def read_list(path: Path) -> list[str]:
    """The references in a text file, one a line; empty lines and those that begin with # are passed over.

    Raises:
        InputError: no such file, one that is too large, or no text.
    """
    lines = (line.strip() for line in read_text(path, _LARGEST_LIST_BYTES).splitlines())
    return [line for line in lines if line and not line.startswith("#")]


def _each(references: Iterable[str], on_folder: Callable[[str, InFolder], None]) -> Iterator[str]:
    for reference in references:
        # A run leaves a folder that is called like its task.
        if os.path.isdir(reference) and reference not in builtin_tasks():
            found = in_folder(Path(reference))
            on_folder(reference, found)
            yield from found.references
            continue
        row = _ROW_OF_MEMBERS.fullmatch(reference)
        if row is None:
            yield reference
            continue
        first, last = int(row[2]), int(row[3])
        if last < first or last - first >= _MOST_ITEMS:
            allowed = f"must run from a seed to a later one, {_MOST_ITEMS} at most"
            raise InputError("batch", reference, allowed)
        yield from (f"{row[1]}{seed}{row[4] or ''}" for seed in range(first, last + 1))


def _absolute(reference: str, hand: str | None) -> str:
    if looks_like_mesh(reference):
        return os.path.abspath(reference)
    task, own = split_reference(reference if hand is None else with_hand(reference, hand))
    return with_hand(_as_file(task), None if own is None else _as_file(own))


def _as_file(name: str) -> str:
    return os.path.abspath(name) if name.lower().endswith(HAND_SUFFIXES) else name


def _without_folders(reference: str) -> str:
    """`tasks/pinch.yaml@hands/my.yaml` as `pinch@my`."""
    task, hand = split_reference(reference)
    parts = [task] if hand is None else [task, hand]
    return "@".join(re.sub(r"\.[A-Za-z]+$", "", part.rsplit("/", 1)[-1]) for part in parts)
