"""Options of `holdfast hold`."""

import argparse

from ...converters import whole_number
from ...shared_options import add_grasp, add_json
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast hold clear.json", "its task's test"),
    ("holdfast hold clear.json --margin --robust 20", "how much more it carries, and with noise"),
    ("holdfast hold clear.json --preset all", "what other protocols say"),
    ("holdfast hold clear.json --engine warp", "in MuJoCo Warp, on a GPU if there is one"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_grasp(parser)
    test = parser.add_argument_group("the test")
    test.add_argument(
        "--preset",
        metavar="NAME",
        help="holdfast, no_noslip, dexgraspbench, dexonomy, dexgraspnet, multidex or graspqp; all to compare "
        "(holdfast; in Warp no_noslip)",
    )
    test.add_argument(
        "--engine",
        choices=("mujoco", "warp"),
        default="mujoco",
        help="what simulates: MuJoCo, or MuJoCo Warp on a GPU if there is one, lifts alone; needs "
        "holdfast[gpu] (mujoco)",
    )
    test.add_argument(
        "--directions",
        metavar="SET",
        help="of gravity, in place of the preset's: task (the task's own), six, or sphere (26)",
    )
    more = parser.add_argument_group("more about its verdict")
    more.add_argument(
        "--margin", action="store_true", help="search for the multiple of the load at which it first fails"
    )
    more.add_argument(
        "--agree", action="store_true", help="repeat it at half the time step, with another solver, and so on"
    )
    more.add_argument(
        "--robust",
        type=whole_number(1),
        metavar="N",
        help="repeat it N times with noise of pose and friction",
    )
    more.add_argument("--seed", type=whole_number(0), default=0, metavar="N", help="of the noise (0)")
    parser.add_argument(
        "--out", type=file_target, metavar="FILE", help="write the grasp with the result of the test"
    )
    add_json(parser)
