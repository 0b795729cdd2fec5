"""What the commands that take a mesh, or an object, in place of a task have in common."""

import argparse
from pathlib import Path

from ....base.text.console import Console
from ....errors import InputError
from ....objects import looks_like_mesh
from ...run_object import GraspRequest, ObjectFiles
from ...suggest import Suggestions, suggest
from ..interrupt import stop_on_interrupt

__all__ = ["check_no_mesh_options", "is_mesh", "requested", "show_reading", "task_of_object"]

_OPTIONS = ("mass", "friction", "scale", "units", "contacts", "save")
_OF_ANY_OBJECT = ("contacts", "save")
_FOR_OTHERS_TOO = (("suggest", "contacts"), ("edit", "save"))
# Share of the time that `solve` looks for contacts.
_SUGGESTING = 0.5


def is_mesh(name: str) -> bool:
    """Whether an argument is the path of a mesh file."""
    return looks_like_mesh(name)


def show_reading(console: Console, name: str) -> None:
    """Shows what a command is at while it reads a mesh, which takes up to a minute the first time."""
    if is_mesh(name):
        console.pass_by(f"{Path(name).name}: read, mended and cut into convex pieces")


def check_no_mesh_options(arguments: argparse.Namespace, owner: str) -> None:
    """Refuses what goes with a mesh file, or with an object, where there is none.

    Args:
        arguments: of the command.
        owner: what has these figures of its own, such as `a task`.

    Raises:
        InputError: an option of a mesh was given.
    """
    for option in _OPTIONS:
        given = getattr(arguments, option, None)
        if given is not None and (arguments.command, option) not in _FOR_OTHERS_TOO:
            goes_with = "an object" if option in _OF_ANY_OBJECT else "a mesh file"
            raise InputError(arguments.command, f"--{option}", f"goes with {goes_with}; {owner} has its own")


def requested(arguments: argparse.Namespace, obj: str) -> GraspRequest:
    """The object and the hand that the options of a command name."""
    return GraspRequest(
        obj,
        arguments.hand or "sa",
        mass_kg=arguments.mass,
        friction=arguments.friction,
        scale=arguments.scale,
        units=arguments.units,
        contacts=arguments.contacts,
    )


def task_of_object(arguments: argparse.Namespace, console: Console) -> tuple[str | None, Suggestions]:
    """The best task that was found for an object, written as a file; None where there is none.

    Returns:
        The reference that loads it, and all that was found.

    Raises:
        InputError: an object, a hand or a figure that can't be used.
    """
    request = requested(arguments, arguments.task)
    hand = request.load_hand()
    show_reading(console, request.object)
    files = ObjectFiles(request, Path(arguments.save or f"{Path(arguments.task).stem}_task"))
    wanted = "as few contacts as carry it" if request.contacts is None else f"{request.contacts} contacts"
    console.say(f"looking for {wanted} of {hand.name} on {files.object.name}")
    with stop_on_interrupt(console.say) as should_stop:
        found = suggest(
            hand,
            files.object,
            contacts=request.contacts,
            count=1,
            seed=arguments.seed,
            budget_s=_SUGGESTING * arguments.budget,
            on_progress=lambda tried, kept: console.pass_by(f"  {tried} tried, {kept} reached"),
            should_stop=should_stop,
        )
    return files.reference(files.write_task(found[0], 1)) if found else None, found
