"""Options of `holdfast batch`."""

import argparse

from ...converters import positive, whole_number
from ...shared_options import (
    add_choose,
    add_clearance,
    add_cluster,
    add_contacts,
    add_mesh,
    add_quiet,
    add_search,
    add_wanted,
)
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast batch upholding handling pinch.yaml --out many", "three tasks, into many/index.html"),
    ("holdfast batch family:mug:0-99 cup.obj --out many --hand shadow", "a hundred mugs and a mesh"),
    ("holdfast batch --list tasks.txt --out many --quick", "one task a line; verdicts alone"),
    ("holdfast batch --resume --out many", "go on where it was killed, with the same tasks and settings"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "tasks",
        nargs="*",
        metavar="TASK",
        help="a task or a mesh as `holdfast run` takes it, a folder of them, or a row of a family, such as "
        "family:mug:0-99",
    )
    parser.add_argument("--list", metavar="FILE", help="a text file with more of them, one a line")
    search = parser.add_argument_group("what is looked for in each")
    add_search(search, 120.0, rounds=True)
    add_wanted(search)
    add_clearance(search)
    add_choose(search)
    add_contacts(add_mesh(parser, "a TASK"), "as few as can carry it, and one more, in turn")
    folder = parser.add_argument_group("what is done, and where it goes")
    folder.add_argument(
        "--out", type=folder_target, required=True, metavar="DIR", help="the folder of the batch"
    )
    folder.add_argument("--quick", action="store_true", help="verdicts alone, no margins and pictures")
    folder.add_argument(
        "--resume", action="store_true", help="go on with the batch in the folder; TASKs may be left out"
    )
    folder.add_argument(
        "--workers",
        type=whole_number(1),
        metavar="N",
        help="tasks to run at a time (all cores); the result is the same",
    )
    add_cluster(folder)
    folder.add_argument(
        "--limit",
        type=positive,
        metavar="SECONDS",
        help="time after which a task that does not end is given up (three budgets and a minute)",
    )
    add_quiet(folder)
