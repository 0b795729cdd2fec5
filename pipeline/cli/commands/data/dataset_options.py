"""Options of `holdfast dataset`."""

import argparse

from ...converters import names, numbers, whole_number
from ...shared_options import add_json, add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    (
        "holdfast dataset --families mug,box --objects 8 --hands sa,shadow --out choices",
        "eight objects, each with two hands; the same command goes on where it was interrupted",
    ),
    (
        "holdfast dataset --objects 600 --hands sa,shadow,allegro.urdf --draws 4 --out large",
        "all families, one hand by path",
    ),
    ("holdfast dataset --objects 0 --object mug.obj --object scalpel --out mine", "objects of your own"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "--families", type=names, metavar="NAMES", help="families of objects, with commas between (all)"
    )
    parser.add_argument(
        "--objects", type=whole_number(0), default=12, metavar="N", help="objects of these, in turn (12)"
    )
    parser.add_argument(
        "--first-seed",
        type=whole_number(0),
        default=0,
        metavar="N",
        help="seed of each family's first object (0)",
    )
    parser.add_argument(
        "--object",
        action="append",
        default=[],
        metavar="OBJECT",
        help="a further object: a built-in one, an object file or a mesh; may be given again",
    )
    parser.add_argument(
        "--hands",
        type=names,
        default=("sa",),
        metavar="HANDS",
        help="built-in hands, or paths of hand files (sa)",
    )
    parser.add_argument(
        "--one-hand",
        action="store_true",
        help="each object with one of the hands alone, in turn: more objects in the same time",
    )
    parser.add_argument(
        "--candidates",
        type=whole_number(2),
        default=8,
        metavar="N",
        help="grasps of a situation, at most (8)",
    )
    parser.add_argument(
        "--draws", type=whole_number(1), default=3, metavar="N", help="hidden draws of a situation (3)"
    )
    parser.add_argument(
        "--loads", type=numbers, default=(1.0, 2.0), metavar="LOADS", help="multiples of the load (1,2)"
    )
    parser.add_argument("--seed", type=whole_number(0), default=0, metavar="N", help="random seed (0)")
    parser.add_argument(
        "--workers",
        type=whole_number(1),
        metavar="N",
        help="processes to use; the result is the same for any number (as many as there are cores)",
    )
    parser.add_argument(
        "--out", type=folder_target, default="dataset", metavar="DIR", help="folder of the data set (dataset)"
    )
    parser.add_argument(
        "--licence",
        default="Apache-2.0",
        metavar="NAME",
        help="licence of the data, for its card (Apache-2.0)",
    )
    parser.add_argument(
        "--minari",
        default="",
        metavar="NAME",
        help="put it among Minari's data sets, too, such as mine/choice-v0",
    )
    add_json(parser)
    add_quiet(parser)
