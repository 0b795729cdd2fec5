"""Options of `holdfast tasks`."""

import argparse

from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast tasks", "all that are built in"),
    ("holdfast tasks upholding", "regions, limits and test of one"),
    ("holdfast tasks pinch.yaml", "the same of a file"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="a built-in task, or the path of a file")
    add_json(parser)
