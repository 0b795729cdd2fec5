"""Options of `holdfast view`."""

import argparse

from ...shared_options import add_address, add_quiet

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast view runs/upholding", "every grasp of a run"),
    ("holdfast view runs/upholding/grasps/g01.json --in browser", "one grasp, on a page"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("name", metavar="RUN|GRASP", help="a run folder, or a grasp file")
    parser.add_argument(
        "--task", metavar="TASK", help="take this task in place of the one that the file names"
    )
    parser.add_argument(
        "--in",
        dest="where",
        choices=("browser", "window"),
        metavar="WHERE",
        help="browser: a page; window: MuJoCo's viewer, of the best grasp (window where there is a screen)",
    )
    add_address(parser)
    add_quiet(parser)
