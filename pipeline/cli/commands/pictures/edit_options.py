"""Options of `holdfast edit`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_mesh, add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast edit mug.obj --hand shadow", "a new task for a mesh"),
    ("holdfast edit pinch.yaml --port 8090", "change a task"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", metavar="NAME", help="a mesh, an object or a task, built in or as a file")
    add_mesh(parser, "NAME", None)
    parser.add_argument("--hand", metavar="HAND", help="a built-in hand, or a hand file (sa, or the task's)")
    parser.add_argument(
        "--save",
        type=folder_target,
        metavar="DIR",
        help="where tasks are saved (beside the file; <mesh>_task; else here)",
    )
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS", help="to listen at (127.0.0.1: this machine alone)"
    )
    parser.add_argument(
        "--port",
        type=whole_number(0),
        default=8080,
        metavar="N",
        help="to listen at, or the next free one (8080)",
    )
    add_quiet(parser)
