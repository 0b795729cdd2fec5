"""Options of `holdfast clear`."""

import argparse

from ...shared_options import add_grasp, add_json, add_margin
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast clear found/g01.json --out clear.json", "the grasp without penetration"),
    ("holdfast clear found/g01.json --all", "distances of all pairs of bodies"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_grasp(parser)
    add_margin(parser)
    parser.add_argument("--all", action="store_true", help="show all pairs of bodies, not the nearest alone")
    parser.add_argument("--out", type=file_target, metavar="FILE", help="write the grasp as it is then")
    add_json(parser)
