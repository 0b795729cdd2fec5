"""Options of `holdfast objects`."""

import argparse

from ...shared_options import add_json, add_mesh

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast objects", "all that are built in"),
    ("holdfast objects teapot", "its size, mass, pieces and regions"),
    ("holdfast objects mug.obj --units mm", "the same of a mesh"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="a built-in object, or the path of a file")
    add_mesh(parser, "NAME")
    add_json(parser)
