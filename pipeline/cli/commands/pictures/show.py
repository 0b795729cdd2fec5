"""`holdfast show NAME`."""

import argparse
from pathlib import Path

from .....base.files.yaml_file import read_yaml
from .....base.machine.backend import check_renderer, configure
from .....base.text.console import Console, emit
from .....errors import InputError, UnknownName
from .....hands import HAND_SUFFIXES, builtin_hands, load_hand
from .....mjcf.hand_folder import open_posture
from .....mjcf.render import (
    Diagram,
    draw_diagrams,
    grasp_diagram,
    hand_diagram,
    object_diagram,
    parse_view,
    task_diagrams,
    write_png,
)
from .....objects import builtin_objects, builtin_tasks, load_object, load_task, split_reference
from ....run import folder_name
from .._grasp import load_grasp
from .._object import check_no_mesh_options, is_mesh, show_reading

__all__ = ["kind_of", "main"]

_FILES = (".yaml", ".yml")


def main(arguments: argparse.Namespace) -> int:
    """Draws an object, a hand, a task or a grasp with its regions; prints the path of the picture."""
    view = None if arguments.view is None else parse_view(arguments.view)
    path = Path(arguments.out) if arguments.out else None
    if path is not None and path.suffix.lower() != ".png":
        raise InputError("show", "--out", f"{arguments.out!r} must end in .png")
    configure()
    check_renderer()
    console = Console(quiet=arguments.quiet)
    show_reading(console, arguments.name)
    stem, diagrams = _diagrams(arguments)
    console.say(f"drawing {', '.join(diagram.title for diagram in diagrams)}")
    path = path or Path(f"{folder_name(stem)}_shown.png")
    write_png(path, draw_diagrams(diagrams, view))
    emit(str(path))
    return 0


def kind_of(name: str) -> str:
    """`grasp`, `task`, `hand` or `object`: what a name or a file stands for.

    Raises:
        UnknownName: nothing is called so.
        InputError: a file that can't be read.
    """
    lower = name.lower()
    if lower.endswith(".json"):
        return "grasp"
    if is_mesh(name) or name.startswith("family:"):
        return "object"
    task, hand = split_reference(name)
    if hand is not None:
        return "task"
    if lower.endswith(_FILES):
        fields = read_yaml(Path(name))
        if "contacts" in fields:
            return "task"
        return "hand" if {"links", "fingers", "import"} & set(fields) else "object"
    if lower.endswith(HAND_SUFFIXES):
        return "hand"
    known = {"task": builtin_tasks(), "hand": builtin_hands(), "object": builtin_objects()}
    for kind, names in known.items():
        if task in names or (kind == "task" and task.partition("/")[2] in names):
            return kind
    every = [name for names in known.values() for name in names]
    raise UnknownName("show", "", "object, hand or task", name, every)


def _diagrams(arguments: argparse.Namespace) -> tuple[str, list[Diagram]]:
    """A name for the picture's file, and what is drawn."""
    name = arguments.name
    kind = kind_of(name)
    if not is_mesh(name):
        check_no_mesh_options(arguments, f"{'an' if kind == 'object' else 'a'} {kind}")
    match kind:
        case "grasp":
            loaded = load_grasp(Path(name), None)
            stem = Path(name).stem
            return stem, [grasp_diagram(loaded.configuration, loaded.record.id or stem)]
        case "task":
            task = load_task(name)
            return task.name, list(task_diagrams(task, open_posture(task.hand)))
        case "hand":
            hand = load_hand(name)
            return hand.name, [hand_diagram(hand, open_posture(hand))]
        case _:
            obj = load_object(
                name,
                mass_kg=arguments.mass,
                friction=arguments.friction,
                scale=arguments.scale,
                units=arguments.units,
                source="show",
            )
            return obj.name, [object_diagram(obj)]
