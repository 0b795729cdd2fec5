"""Options of `holdfast edit`."""

import argparse

from ...shared_options import add_address, add_mesh, add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast edit mug.obj --hand shadow", "a new task for a mesh"),
    ("holdfast edit pinch.yaml --port 8090", "change a task"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", metavar="NAME", help="a mesh, an object or a task, built in or as a file")
    add_mesh(parser, "NAME")
    parser.add_argument("--hand", metavar="HAND", help="a built-in hand, or a hand file (sa, or the task's)")
    parser.add_argument(
        "--save",
        type=folder_target,
        metavar="DIR",
        help="where tasks are saved (beside the file; <mesh>_task; else here)",
    )
    add_address(parser)
    add_quiet(parser)
