"""Options of `holdfast batch`."""

import argparse

from ...converters import positive, whole_number
from ...shared_options import add_cluster, add_margin, add_mesh, add_quiet, add_search
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
        help="a task or a mesh as `holdfast run` takes it, or a row of a family, such as family:mug:0-99",
    )
    parser.add_argument("--list", metavar="FILE", help="a text file with more of them, one a line")
    parser.add_argument(
        "--out", type=folder_target, required=True, metavar="DIR", help="the folder of the batch"
    )
    parser.add_argument(
        "--wanted",
        type=whole_number(0),
        default=5,
        metavar="N",
        help="grasps that should hold of each task before no more are looked for (5); 0 for one round",
    )
    add_search(parser, 120.0)
    add_margin(parser)
    parser.add_argument(
        "--workers",
        type=whole_number(1),
        metavar="N",
        help="tasks to run at a time (all cores); the result is the same",
    )
    add_cluster(parser)
    parser.add_argument(
        "--limit",
        type=positive,
        metavar="SECONDS",
        help="time after which a task that does not end is given up (three budgets and a minute)",
    )
    parser.add_argument("--quick", action="store_true", help="verdicts alone, no margins and pictures")
    parser.add_argument(
        "--resume", action="store_true", help="go on with the batch in the folder; TASKs may be left out"
    )
    add_mesh(parser, "a TASK", "as few as can carry it, and one more, in turn", save=False)
    add_quiet(parser)
