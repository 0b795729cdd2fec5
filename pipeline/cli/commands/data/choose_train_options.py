"""Options of `holdfast choose train`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_quiet
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    (
        "holdfast choose train grasps --out model.json",
        "gradient boosting on the data set in the folder grasps",
    ),
    (
        "holdfast choose train grasps --policy ranker --without-hand shadow --out model.json",
        "by what hands share, to be tried on a hand that it has not seen",
    ),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("data", metavar="DATA", help="a data set: a folder that `holdfast dataset` has made")
    parser.add_argument(
        "--policy",
        default="team",
        metavar="NAME",
        help="team, boosting, advantage, ranker, blend, logistic, linucb, maskable_ppo, springs, random, "
        "first, or formula: with the name of a measure (team)",
    )
    parser.add_argument(
        "--out", type=file_target, required=True, metavar="FILE", help="the model file, such as model.json"
    )
    parser.add_argument(
        "--without-hand",
        action="append",
        default=[],
        metavar="HAND",
        help="leave a hand's grasps out, and with them all that speaks of one hand alone; may be repeated",
    )
    parser.add_argument(
        "--free", action="store_true", help="leave out what speaks of one hand alone, such as its joints"
    )
    parser.add_argument("--seed", type=whole_number(0), default=0, metavar="N", help="random seed (0)")
    add_quiet(parser)
