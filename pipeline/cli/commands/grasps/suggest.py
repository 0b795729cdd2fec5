"""`holdfast suggest OBJECT`."""

import argparse
from dataclasses import asdict
from pathlib import Path

from .....base.files.library import FILE_SUFFIXES
from .....base.text.console import Console, emit, emit_json, format_table
from .....objects import load_task
from ....run_object import ObjectFiles
from ....suggest import Suggestion, Suggestions, Tried, suggest
from ...interrupt import stop_on_interrupt
from .._object import check_no_mesh_options, is_mesh, requested, show_reading

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Proposes tasks for an object and a hand, and writes each as a task file."""
    console = Console(quiet=arguments.quiet)
    if not is_mesh(arguments.object):
        check_no_mesh_options(arguments, "an object")
    request = requested(arguments, arguments.object)
    hand = request.load_hand()
    folder = Path(arguments.out) if arguments.out else _usual_folder(arguments.object)
    show_reading(console, request.object)
    files = ObjectFiles(request, folder)
    obj = files.object
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
    tasks = [_written(files, number, s) for number, s in enumerate(found, start=1)]
    if arguments.json:
        emit_json(
            arguments.json,
            {
                "suggestions": [_as_json(s, t) for s, t in zip(found, tasks, strict=True)],
                "tried": _tried_as_json(found.tried),
            },
        )
    if arguments.json != "-":
        _print(found, tasks)
    return 130 if interrupted else 0 if found else 4


def _usual_folder(obj: str) -> Path:
    """Beside the object's own file, or a folder for what has none."""
    return Path(obj).parent if obj.lower().endswith(FILE_SUFFIXES) else Path("suggestions")


def _written(files: ObjectFiles, number: int, suggestion: Suggestion) -> str:
    """The reference that loads a suggestion, once it is a task file."""
    reference = files.reference(files.write_task(suggestion, number))
    load_task(reference)  # a suggestion that can't be read again would be worth nothing
    return reference


def _as_json(suggestion: Suggestion, task: str) -> dict[str, object]:
    return {
        "task": task,
        "score": suggestion.score,
        "reach": suggestion.reach,
        "quality": suggestion.quality.as_record(),
        "contacts": [[c.hand.name, c.object.name] for c in suggestion.task.contacts],
    }


def _tried_as_json(tried: Tried) -> dict[str, object]:
    counts = asdict(tried)
    blocking = counts.pop("blocking")
    return {**counts, "blocking": [[*pair, count] for pair, count in blocking.items()]}


def _print(found: Suggestions, tasks: list[str]) -> None:
    if not found:
        emit(str(found))
        return
    header = ("task", "touching (object frame, mm)", "epsilon/N", "load/weight", "reach")
    rows = [
        (
            task,
            suggestion.touching,
            f"{suggestion.quality.epsilon:.3f}",
            f"{suggestion.quality.wrench_margin:.1f}",
            f"{suggestion.reach:.2f}",
        )
        for suggestion, task in zip(found, tasks, strict=True)
    ]
    emit(format_table(header, rows))
