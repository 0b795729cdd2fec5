"""Options of `holdfast best`."""

import argparse

from ...converters import positive, share, whole_number
from ...shared_options import add_json, add_quiet, add_sharing
from ...targets import file_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast best upholding --for friction", "to 2 %, within a minute"),
    ("holdfast best upholding --for friction --gap 0.001 --proof low.proof", "nearer, with a proof"),
    ("holdfast best upholding --for friction --with-hand --gap 0.05", "by a configuration of its hand"),
    ("holdfast best upholding --for load --max-force 20", "the largest load, with 20 N a contact at most"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument("task", metavar="TASK", help="a built-in task, or the path of a task file")
    parser.add_argument(
        "--for",
        dest="goal",
        required=True,
        choices=("friction", "load"),
        metavar="GOAL",
        help="friction: the least coefficient with which forces at points of the regions carry the load; "
        "load: the largest multiple of it that they carry whichever way gravity acts",
    )
    parser.add_argument(
        "--max-force",
        type=positive,
        metavar="NEWTONS",
        help="for load: largest normal force of each contact (that of the task or its hand, or what "
        "the hand's fingertips are rated for)",
    )
    parser.add_argument(
        "--with-hand",
        action="store_true",
        help="of what the task's hand reaches of the regions: the value is that of a certified "
        "configuration, and parts that the hand is proved not to reach don't count",
    )
    parser.add_argument(
        "--gap", type=share, default=0.02, metavar="SHARE", help="stop where the proof is so near (0.02)"
    )
    parser.add_argument(
        "--budget", type=positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    parser.add_argument(
        "--seed", type=whole_number(0), default=0, metavar="N", help="of the local search (0)"
    )
    parser.add_argument(
        "--proof",
        type=file_target,
        metavar="FILE",
        help="write a proof of what is refuted, for `holdfast check-proof`",
    )
    add_sharing(parser)
    add_json(parser)
    add_quiet(parser)
