"""Options of `holdfast hands new`."""

import argparse

from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast hands new my_hand.yaml --model hand.xml", "from a model in the folder of my_hand.yaml"),
    ("holdfast hands new my_hand.yaml", "a small example, to edit"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "file", type=file_target, metavar="FILE", help="the hand file to write, such as my_hand.yaml"
    )
    parser.add_argument(
        "--model",
        metavar="MODEL",
        help="an MJCF or URDF model in or below the folder of FILE, or a hand to copy (a small example)",
    )
    parser.add_argument("--mirror", action="store_true", help="the hand is the mirror image of it")
    parser.add_argument("--force", action="store_true", help="write over a file that is there")
