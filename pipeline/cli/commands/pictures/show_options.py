"""Options of `holdfast show`."""

import argparse

from ...shared_options import add_mesh, add_quiet
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast show mug.obj --units mm", "a mesh: mug_shown.png"),
    ("holdfast show upholding --view 30,20 -o task.png", "a task from a side of one's choice"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "name",
        metavar="NAME",
        help="an object, a hand or a task, built in or as a file; a mesh; a grasp file (.json)",
    )
    parser.add_argument(
        "-o", "--out", type=file_target, metavar="FILE", help="the picture, a .png (<name>_shown.png)"
    )
    parser.add_argument(
        "--view",
        metavar="VIEW",
        help="front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees "
        "(two sides that show most regions)",
    )
    add_mesh(parser, "NAME")
    add_quiet(parser)
