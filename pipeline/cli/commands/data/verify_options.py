"""Options of `holdfast verify`."""

import argparse

from ...converters import positive, whole_number
from ...shared_options import add_json, add_mesh, add_quiet
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast verify grasps.yaml --hand gripper.urdf --object mug.obj", "what touches, sinks in and holds"),
    ("holdfast verify *.npy --hand hand.xml --object bottle.obj --no-hold", "without simulation"),
    ("holdfast verify grasps.json --hand sa --object box.yaml --out judged", "with a page and fixed grasps"),
    ("holdfast verify grasps.npy --hand hand.xml --object cup.obj --quaternion xyzw", "say what is open"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="files of grasps, of any format that is read"
    )
    parser.add_argument(
        "--hand", required=True, metavar="HAND", help="a built-in hand, or the path of its file or model"
    )
    parser.add_argument(
        "--object",
        required=True,
        metavar="OBJECT",
        help="a built-in object, or the path of an object file or a mesh",
    )
    add_mesh(parser, "OBJECT")
    _add_answers(parser)
    parser.add_argument(
        "--posture",
        choices=("grasp", "pregrasp", "squeeze"),
        metavar="MOMENT",
        default="grasp",
        help="which moment of each grasp is judged: pregrasp, grasp or squeeze (grasp)",
    )
    parser.add_argument(
        "--count", type=whole_number(1), metavar="N", help="grasps to judge, the first ones (all)"
    )
    parser.add_argument(
        "--preset", action="append", metavar="NAME", help="a hold test to try; may be repeated (all of them)"
    )
    parser.add_argument("--no-hold", action="store_true", help="try no hold tests")
    parser.add_argument("--no-nearby", action="store_true", help="look for no certified grasps nearby")
    parser.add_argument(
        "--prove",
        type=positive,
        metavar="SECONDS",
        help="time for the solver where no grasp is found nearby: finds one, or proves that there is none",
    )
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="folder for a page with pictures, and the certified grasps in the format of the files",
    )
    add_json(parser)
    add_quiet(parser)


def _add_answers(parser: argparse.ArgumentParser) -> None:
    """What files may leave open; geometry decides where nothing is said."""
    group = parser.add_argument_group("how numbers are meant, where that is known")
    group.add_argument(
        "--quaternion",
        choices=("wxyz", "xyzw"),
        metavar="ORDER",
        help="the order of quaternions: wxyz or xyzw",
    )
    group.add_argument("--length", choices=("m", "mm"), metavar="UNIT", help="the unit of positions: m or mm")
    group.add_argument(
        "--angle", choices=("rad", "deg"), metavar="UNIT", help="the unit of angles: rad or deg"
    )
    group.add_argument(
        "--joint-length", choices=("m", "mm"), metavar="UNIT", help="the unit of joints that slide: m or mm"
    )
    group.add_argument(
        "--scale-is",
        choices=("times", "divided", "none"),
        metavar="HOW",
        help="whether the object is its mesh times its scale, divided by it, or just as it is (none)",
    )
    group.add_argument(
        "--frame",
        metavar="NAME",
        help="the hand's frame that poses are of: base, tcp, model or a link's name",
    )
    group.add_argument(
        "--direction",
        choices=("hand_in_object", "object_in_hand"),
        metavar="WAY",
        help="hand_in_object or object_in_hand: whose pose is written, in whose frame",
    )
    group.add_argument("--joint-order", metavar="NAME", help="what joint values without names follow")
