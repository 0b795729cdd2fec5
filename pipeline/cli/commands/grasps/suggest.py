"""`holdfast suggest OBJECT`."""

import argparse
import os
from dataclasses import asdict
from pathlib import Path

from .....base.files.file_paths import real_path
from .....base.files.output_file import write_text
from .....base.text.console import Console, emit, emit_json, format_table
from .....errors import InputError
from .....hands import HAND_SUFFIXES, load_hand
from .....objects import load_object, load_task
from ....run_object import ObjectFiles
from ....suggest import Suggestion, Suggestions, Tried, suggest, task_text
from ...interrupt import stop_on_interrupt
from .._object import check_no_mesh_options, is_mesh, requested

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Proposes tasks for an object and a hand, and writes each as a task file."""
    console = Console(quiet=arguments.quiet)
    given = _Mesh(arguments) if is_mesh(arguments.object) else _Named(arguments)
    hand, obj = given.hand, given.object
    wanted = "as few contacts as carry it" if arguments.contacts is None else f"{arguments.contacts} contacts"
    console.say(f"looking for {wanted} of {hand.name} on {obj.name}")
    with stop_on_interrupt(console.say) as should_stop:
        found = suggest(
            hand,
            obj,
            contacts=arguments.contacts,
            count=arguments.count,
            seed=arguments.seed,
            budget_s=arguments.budget,
            on_progress=lambda tried, kept: console.pass_by(f"  {tried} tried, {kept} reached"),
            should_stop=should_stop,
        )
        interrupted = should_stop()
    paths = [given.write(number, s) for number, s in enumerate(found, start=1)]
    if arguments.json:
        emit_json(
            arguments.json,
            {
                "suggestions": [_as_json(s, p) for s, p in zip(found, paths, strict=True)],
                "tried": _tried_as_json(found.tried),
            },
        )
    if arguments.json != "-":
        _print(found, paths)
    return 130 if interrupted else 0 if found else 4


class _Named:
    """An object with a name or a file of its own, and where its tasks go."""

    def __init__(self, arguments: argparse.Namespace):
        check_no_mesh_options(arguments, "an object")
        self._folder = Path(arguments.out) if arguments.out else _own_folder(arguments.object)
        self._hand_name = _reference(arguments.hand, self._folder, "--hand")
        self._object_name = _reference(arguments.object, self._folder, "OBJECT")
        self.hand, self.object = load_hand(arguments.hand), load_object(arguments.object)

    def write(self, number: int, suggestion: Suggestion) -> Path:
        """Writes a suggestion as a task file."""
        name = f"{suggestion.task.name}_{number}"
        path = self._folder / f"{name}.yaml"
        write_text(path, task_text(suggestion, name, self._hand_name, self._object_name))
        load_task(path)  # a suggestion that can't be read again would be worth nothing
        return path


class _Mesh:
    """A mesh, of which an object file is made beside the tasks."""

    def __init__(self, arguments: argparse.Namespace):
        request = requested(arguments, arguments.object)
        self.hand = request.load_hand()
        self._files = ObjectFiles(request, Path(arguments.out or "suggestions"))
        self.object = self._files.object

    def write(self, number: int, suggestion: Suggestion) -> Path:
        """Writes a suggestion as a task file."""
        path = self._files.write_task(suggestion, number)
        load_task(self._files.reference(path))
        return path


def _own_folder(obj: str) -> Path:
    """Beside the object's file, as a task's paths don't leave its folder; else a folder of its own."""
    return Path(obj).parent if _is_path(obj) else Path("suggestions")


def _is_path(name: str) -> bool:
    return name.lower().endswith(HAND_SUFFIXES)


def _reference(name: str, folder: Path, field: str) -> str:
    """How a task file in `folder` names a hand or an object."""
    if not _is_path(name):
        return name
    relative = Path(os.path.relpath(real_path(Path(name)), real_path(folder)))
    if ".." in relative.parts:
        raise InputError(
            "suggest", field, f"{name!r} must lie in or below the folder of the task files {folder}"
        )
    return relative.as_posix()


def _as_json(suggestion: Suggestion, path: Path) -> dict[str, object]:
    return {
        "task": str(path),
        "score": suggestion.score,
        "reach": suggestion.reach,
        "quality": suggestion.quality.as_record(),
        "contacts": [[c.hand.name, c.object.name] for c in suggestion.task.contacts],
    }


def _tried_as_json(tried: Tried) -> dict[str, object]:
    counts = asdict(tried)
    blocking = counts.pop("blocking")
    return {**counts, "blocking": [[*pair, count] for pair, count in blocking.items()]}


def _print(found: Suggestions, paths: list[Path]) -> None:
    if not found:
        emit(str(found))
        return
    header = ("task", "touching (object frame, mm)", "epsilon/N", "load/weight", "reach")
    rows = [
        (
            str(path),
            suggestion.touching,
            f"{suggestion.quality.epsilon:.3f}",
            f"{suggestion.quality.wrench_margin:.1f}",
            f"{suggestion.reach:.2f}",
        )
        for suggestion, path in zip(found, paths, strict=True)
    ]
    emit(format_table(header, rows))
