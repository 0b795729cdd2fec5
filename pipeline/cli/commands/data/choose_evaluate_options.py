"""Options of `holdfast choose evaluate`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_json, add_quiet
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast choose evaluate grasps model.json", "a model on the objects that it was not trained on"),
    (
        "holdfast choose evaluate grasps --out page.html",
        "all policies, trained anew without the object, the hand or the task that they are judged by",
    ),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("data", metavar="DATA", help="a data set: a folder that `holdfast dataset` has made")
    parser.add_argument(
        "models", nargs="*", metavar="MODEL", help="model files; without one, policies are trained anew"
    )
    parser.add_argument("--out", type=file_target, metavar="FILE", help="write a page (.html)")
    parser.add_argument(
        "--policies",
        metavar="NAMES",
        help="which are trained, with commas between (all that need no more than the extra learn)",
    )
    parser.add_argument(
        "--unseen",
        metavar="WHAT",
        help="object, hand, task: what they have not seen, with commas between (all three)",
    )
    parser.add_argument(
        "--seeds", type=whole_number(1), default=5, metavar="N", help="trainings of each policy (5)"
    )
    add_json(parser)
    add_quiet(parser)
