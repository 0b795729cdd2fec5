"""Every command, in the groups and the order in which help shows them.

A command `NAME` of a group is two modules in the group's folder below `commands/`: `NAME_options.py` with its
options and examples (light: help imports it), and `NAME.py` with `main(arguments)`, imported when it runs.
"""

import argparse
import gc
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Protocol

__all__ = ["COMMANDS", "GROUPS", "Command", "Examples", "Group", "find_command"]

Examples = tuple[tuple[str, str], ...]
"""Command lines, each with what it does."""


@dataclass(frozen=True)
class Group:
    """Commands that belong together.

    Attributes:
        folder: below `commands/`, with their modules.
        title: over them in help.
        commands: what each does in a line, by its name.
    """

    folder: str
    title: str
    commands: dict[str, str]


GROUPS = (
    Group(
        "grasps",
        "find grasps and test them",
        {
            "run": "all stages on a task: solve, retract, squeeze, hold, report",
            "suggest": "tasks for an object: regions with force closure that the hand reaches",
            "solve": "the solver alone: certified configurations, or a proof that there are none",
            "clear": "free a grasp of penetration, keeping its contacts",
            "hold": "squeeze a grasp and put it to its test in simulation",
        },
    ),
    Group(
        "pictures",
        "look at them",
        {
            "report": "write the report of a run anew",
            "view": "turn and play grasps: a page in the browser, or MuJoCo's window",
            "compare": "in what two runs differ: settings, counts, verdicts, times",
            "show": "a picture of an object, a hand, a task or a grasp, with its regions",
            "render": "draw a grasp from four sides, and its hold as a filmstrip",
            "edit": "place regions, solve and save a task, in the browser",
        },
    ),
    Group(
        "data",
        "many grasps at once",
        {
            "batch": "run any number of tasks and meshes, into one folder with a page and a table",
            "table": "the grasps of runs as one table, a row a grasp",
            "query": "ask a table of grasps a question in SQL",
            "check": "try a row of a table again, or look whether all its rows are whole",
            "choose train": "train a policy that chooses among candidate grasps",
            "choose evaluate": "compare such policies on objects, hands and tasks that they have not seen",
            "dataset": "candidates of many objects and hands with their outcomes, to learn choosing from",
            "export": "grasps as files of other programs, or as models of hand and object",
            "verify": "judge grasps made elsewhere, and find certified ones near them",
        },
    ),
    Group(
        "catalogue",
        "hands, objects and tasks",
        {
            "tasks": "what tasks are built in; with a name or a file, its details",
            "hands": "what hands are built in; with a name or a file, its details",
            "objects": "what objects are built in; with a name or a file, its details",
            "hands new": "a hand file to edit, complete, with the contact regions of a model",
            "objects fit": "a Bezier patch fitted to the surface of a mesh, as a contact region",
        },
    ),
    Group(
        "proofs",
        "proofs and equations",
        {
            "best": "the least friction that holds a task's load, or the largest load it carries, proved",
            "check-proof": "replay a proof log, or what a grasp file says was proved, in own arithmetic",
            "system": "all real solutions of a polynomial system in a box, or a proof of none",
        },
    ),
    Group(
        "machine",
        "this machine",
        {
            "doctor": "what is found on this machine, and what to do: renderer, versions, caches, extras",
            "serve": "solve, run, verify and show for other programs: JSON over HTTP here, or MCP",
            "completion": "completion of commands, options and names for the shell",
        },
    ),
)


class _Options(Protocol):
    EXAMPLES: Examples

    def add_options(self, parser: argparse.ArgumentParser) -> None: ...


class _Runs(Protocol):
    def main(self, arguments: argparse.Namespace) -> int: ...


@dataclass(frozen=True)
class Command:
    """One command.

    Attributes:
        name: one word, or two, such as `hands new`.
        summary: what it does, in a line.
        group: folder of its modules below `commands/`.
        draws: whether it always asks which renderer works, which takes a while to be answered.
    """

    name: str
    summary: str
    group: str
    draws: bool

    @property
    def options(self) -> _Options:
        """The module of its options, imported."""
        return import_module(f"{self._module}_options", __package__)

    @property
    def runs(self) -> _Runs:
        """The module that does it, imported; MuJoCo, FCL, SciPy and numba take a second or two."""
        collects = gc.isenabled()
        gc.disable()  # what is imported stays: looking for garbage among it takes a twentieth of the time
        try:
            return import_module(self._module, __package__)
        finally:
            if collects:
                gc.enable()

    @property
    def module_name(self) -> str:
        """Of the module that does it, in its group's folder."""
        return self.name.replace("-", "_").replace(" ", "_")

    @property
    def _module(self) -> str:
        return f".commands.{self.group}.{self.module_name}"


_DRAWING = ("run", "clear", "hold", "batch", "show", "render", "export", "hands new")

COMMANDS = {
    name: Command(name, summary, group.folder, name in _DRAWING)
    for group in GROUPS
    for name, summary in group.commands.items()
}


def find_command(words: Sequence[str]) -> tuple[Command | None, list[str]]:
    """The command that words begin with, and the words after it; None where they begin with no command."""
    for count in (2, 1):
        command = COMMANDS.get(" ".join(words[:count])) if len(words) >= count else None
        if command is not None:
            return command, list(words[count:])
    return None, list(words)
