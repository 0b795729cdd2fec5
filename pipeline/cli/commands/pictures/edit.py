"""`holdfast edit NAME`."""

import argparse
from pathlib import Path
from time import sleep

from .....base.text.console import Console, emit
from .....errors import InputError
from .....hands import load_hand
from .....mjcf.hand_folder import open_posture
from .....objects import load_object, load_task, split_reference, with_hand
from ....edit import Draft, EditorPage, EditSource
from ...catalogue import entries
from ...interrupt import stop_on_interrupt
from .._object import check_no_mesh_options, is_mesh, show_reading
from .show import kind_of

__all__ = ["main", "opened"]

_FILES = (".yaml", ".yml")
# How often it is asked whether to end.
_TICK_S = 0.2


def main(arguments: argparse.Namespace) -> int:
    """Serves the editor's page until Ctrl-C; prints its address."""
    console = Console(quiet=arguments.quiet)
    show_reading(console, arguments.name)
    draft, source, folder = opened(arguments)
    page = EditorPage(
        draft, source, folder, open_posture(draft.hand), host=arguments.host, port=arguments.port
    )
    try:
        emit(page.url)
        console.say(f"tasks are saved into {folder}; Ctrl-C ends the editor")
        with stop_on_interrupt(console.say) as should_stop:
            while not should_stop():
                sleep(_TICK_S)
    finally:
        page.stop()
    return 0


def opened(arguments: argparse.Namespace) -> tuple[Draft, EditSource, Path]:
    """What is edited, where it came from, and the folder in which it is saved.

    Raises:
        InputError: no such object or task, or one that can't be used.
    """
    name, kind = arguments.name, kind_of(arguments.name)
    if kind not in ("object", "task"):
        raise InputError("edit", "", f"{name!r} is a {kind}: name an object, a mesh or a task")
    if not is_mesh(name):
        check_no_mesh_options(arguments, f"{'an' if kind == 'object' else 'a'} {kind}")
    if kind == "task":
        reference = with_hand(name, arguments.hand)
        task = load_task(reference)
        plain, hand = split_reference(reference)
        file = _task_file(plain)
        source = EditSource(hand=hand or "", task_file=file)
        folder = file.parent if plain.endswith(_FILES) else Path()
        return Draft(task.hand, task.object, task), source, Path(arguments.save or folder)
    hand_name = arguments.hand or "sa"
    figures = {option: getattr(arguments, option) for option in ("friction", "scale", "units")}
    source = EditSource(name, hand_name, mass_kg=arguments.mass, **figures)
    obj = load_object(name, mass_kg=arguments.mass, **figures, source="edit")
    draft = Draft(load_hand(hand_name, source="edit", field="--hand"), obj)
    if source.is_mesh:
        folder = Path(f"{obj.name}_task")
    else:
        folder = Path(name).parent if name.endswith(_FILES) else Path()
    return draft, source, Path(arguments.save or folder)


def _task_file(name: str) -> Path:
    """The file of a task, built in or by path."""
    if name.endswith(_FILES):
        return Path(name)
    known = {entry.name: entry.path for entry in entries("task")}
    return known.get(name) or known[name.partition("/")[2]]
