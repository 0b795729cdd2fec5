"""`holdfast suggest OBJECT`."""

import argparse
import os
from pathlib import Path

from ....console import Console, emit, emit_json, format_table
from ....errors import InputError
from ....files import write_text
from ....hands import HAND_SUFFIXES, load_hand
from ....objects import load_object, load_task
from ...suggest import Suggestion, suggest, task_text
from ..interrupt import stop_on_interrupt

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Proposes tasks for an object and a hand, and writes each as a task file."""
    console = Console(quiet=arguments.quiet)
    folder = Path(arguments.out) if arguments.out else _own_folder(arguments.object)
    names = {
        "hand": _reference(arguments.hand, folder, "--hand"),
        "obj": _reference(arguments.object, folder, "OBJECT"),
    }
    hand, obj = load_hand(arguments.hand), load_object(arguments.object)
    console.say(f"looking for {arguments.contacts} contacts of {hand.name} on {obj.name}")
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
    paths = [_write(folder, number, s, names) for number, s in enumerate(found, start=1)]
    if arguments.json:
        emit_json(
            arguments.json, {"suggestions": [_as_json(s, p) for s, p in zip(found, paths, strict=True)]}
        )
    if arguments.json != "-":
        _print(found, paths)
    return 130 if interrupted else 0 if found else 4


def _write(folder: Path, number: int, suggestion: "Suggestion", names: dict[str, str]) -> Path:

    name = f"{suggestion.task.name}_{number}"
    path = folder / f"{name}.yaml"
    write_text(path, task_text(suggestion, name, **names))
    load_task(path)  # a suggestion that can't be read again would be worth nothing
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
    relative = Path(os.path.relpath(Path(name).resolve(), folder.resolve()))
    if ".." in relative.parts:
        raise InputError(
            "suggest", field, f"{name!r} must lie in or below the folder of the task files {folder}"
        )
    return relative.as_posix()


def _as_json(suggestion: "Suggestion", path: Path) -> dict[str, object]:
    return {
        "task": str(path),
        "score": suggestion.score,
        "reach": suggestion.reach,
        "quality": suggestion.quality.as_record(),
        "contacts": [[c.hand.name, c.object.name] for c in suggestion.task.contacts],
    }


def _print(found: list["Suggestion"], paths: list[Path]) -> None:
    if not found:
        emit("no suggestion: no regions with force closure were found that the hand reaches")
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
