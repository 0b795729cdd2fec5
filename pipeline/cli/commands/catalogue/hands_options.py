"""Options of `holdfast hands`."""

import argparse

from ...shared_options import add_json
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast hands", "all that are built in"),
    ("holdfast hands shadow", "its joints and regions"),
    ("holdfast hands my_hand.yaml --mjcf folder", "for plain MuJoCo, with a scene"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="a built-in hand, or the path of a file")
    parser.add_argument(
        "--mjcf",
        type=folder_target,
        metavar="DIR",
        help="write it as a folder for plain MuJoCo, with meshes and a scene",
    )
    parser.add_argument("--mirror", action="store_true", help="take its mirror image")
    add_json(parser)
