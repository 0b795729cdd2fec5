"""Options of `holdfast suggest`."""

import argparse

from ...converters import positive, whole_number
from ...shared_options import add_json, add_mesh, add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast suggest box.yaml --contacts 3", "tasks with three contacts, beside box.yaml"),
    ("holdfast suggest mug.obj --hand shadow --out tasks", "for a mesh, into the folder tasks"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "object", metavar="OBJECT", help="a built-in object, or the path of an object file or a mesh"
    )
    add_mesh(parser, "OBJECT")
    parser.add_argument(
        "--hand", default="sa", metavar="HAND", help="a built-in hand, or the path of its file"
    )
    parser.add_argument(
        "--contacts",
        type=whole_number(2),
        metavar="N",
        help="pairs of regions in each task (as few as can carry the object)",
    )
    parser.add_argument(
        "--count", type=whole_number(1), default=5, metavar="N", help="suggestions wanted (5)"
    )
    parser.add_argument("--seed", type=whole_number(0), default=0, metavar="N", help="random seed (0)")
    parser.add_argument(
        "--budget", type=positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="folder for the task files (beside the object file; else suggestions)",
    )
    add_json(parser)
    add_quiet(parser)
