"""Options of `holdfast check`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    (
        "holdfast check grasps.parquet --row 17",
        "its proof, clearance and hold test again, beside what it says",
    ),
    ("holdfast check grasps.parquet", "whether every row is as it was written"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("file", metavar="FILE", help="a table of `holdfast table` or `holdfast batch`")
    parser.add_argument("--row", type=whole_number(0), metavar="N", help="number of the row to try again")
    parser.add_argument(
        "--task", metavar="TASK", help="take this task in place of the one that the row names"
    )
    add_json(parser)
