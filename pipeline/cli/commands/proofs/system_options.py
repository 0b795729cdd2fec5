"""Options of `holdfast system`."""

import argparse

from ...converters import positive
from ...shared_options import add_json, add_quiet, add_tree

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast system circle.json", "all its solutions, as a table"),
    ("holdfast system circle.json --json -", "as JSON, alone on stdout"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("file", metavar="FILE", help="a system file: variables with intervals, and equations")
    parser.add_argument(
        "--sigma",
        type=positive,
        metavar="WIDTH",
        help="width at which boxes are no longer split (1e-7; 0.05 for fewer equations than unknowns)",
    )
    parser.add_argument(
        "--budget", type=positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    add_tree(parser, "depth")
    add_json(parser)
    add_quiet(parser)
