"""Options of `holdfast solve`."""

import argparse

from ...converters import positive
from ...shared_options import add_json, add_object, add_quiet, add_search, add_task, add_tree
from ...targets import file_target, folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast solve upholding --first", "one configuration, to see whether there is any"),
    ("holdfast solve upholding --candidates 4 --out found", "grasp files found/g01.json to g04.json"),
    (
        "holdfast solve pinch.yaml --proof no.proof --explain 10",
        "where infeasible: the proof, and what would help",
    ),
    ("holdfast solve upholding --json -", "the result as JSON, alone on stdout"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_task(parser)
    search = parser.add_argument_group("what is looked for")
    search.add_argument("--first", action="store_true", help="stop at the first configuration")
    search.add_argument(
        "--all",
        action="store_true",
        help="all solutions: each where they are isolated, else boxes no wider than sigma that cover them",
    )
    search.add_argument(
        "--spread",
        action="store_true",
        help="look for four times as many configurations, and keep those that are far apart",
    )
    add_search(search, 60.0)
    tree = parser.add_argument_group("how it is searched")
    tree.add_argument("--pure", action="store_true", help="branch and prune without local search")
    tree.add_argument(
        "--statics",
        action="store_true",
        help="first try to prove that the regions can't hold the load with the object's friction",
    )
    add_tree(tree, "breadth; depth with --pure")
    add_object(parser, "as few as can carry it")
    told = parser.add_argument_group("what is told, and where it goes")
    told.add_argument(
        "--explain",
        type=positive,
        metavar="SECONDS",
        help="where it is infeasible, relax each contact, limit and region alone, with so much time for each",
    )
    told.add_argument(
        "--proof",
        type=file_target,
        metavar="FILE",
        help="where the task is infeasible, write a proof for `holdfast check-proof`",
    )
    told.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="write each configuration as a grasp file into this folder",
    )
    add_json(told)
    add_quiet(told)
