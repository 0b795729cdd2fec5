"""Options of `holdfast render`."""

import argparse

from ...shared_options import add_grasp
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (("holdfast render runs/upholding/grasps/g01.json", "beside the grasp, into g01_pictures"),)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_grasp(parser)
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="folder for the pictures (beside the grasp file, <id>_pictures)",
    )
