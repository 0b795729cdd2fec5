"""Options of `holdfast check-proof`."""

import argparse

from ...shared_options import add_json

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast check-proof no.proof --task pinch.yaml", "that the task is infeasible"),
    ("holdfast check-proof runs/upholding/grasps/g01.json", "what the file says was proved"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    parser.add_argument(
        "file", metavar="FILE", help="a proof log of `holdfast solve` or `best`, or a grasp file (.json)"
    )
    parser.add_argument("--task", metavar="TASK", help="the task that the log must refute, or of the grasp")
    add_json(parser)
