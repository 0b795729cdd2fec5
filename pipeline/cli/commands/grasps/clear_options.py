"""Options of `holdfast clear`."""

import argparse

from ...shared_options import add_clearance, add_grasp, add_json, add_renamed
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast clear found/g01.json --out clear.json", "the grasp without penetration"),
    ("holdfast clear found/g01.json --every-pair", "distances of all pairs of bodies"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_grasp(parser)
    add_clearance(parser)
    parser.add_argument(
        "--every-pair", action="store_true", help="show all pairs of bodies, not the nearest alone"
    )
    add_renamed(parser, "--all", "--every-pair", nargs=0, const=True)
    parser.add_argument("--out", type=file_target, metavar="FILE", help="write the grasp as it is then")
    add_json(parser)
