"""Options of `holdfast run`."""

import argparse

from ...converters import whole_number
from ...shared_options import (
    add_choose,
    add_clearance,
    add_cluster,
    add_json,
    add_object,
    add_quiet,
    add_search,
    add_task,
    add_wanted,
)
from ...targets import folder_target

__all__ = ["EXAMPLES", "add_options"]

EXAMPLES = (
    ("holdfast run upholding", "a built-in task, into runs/upholding"),
    ("holdfast run pinch.yaml --hand shadow --candidates 6", "a task of one's own, another hand"),
    ("holdfast run mug.obj --mass 0.3 --units mm", "a mesh: contacts are looked for"),
    ("holdfast run box.yaml --contacts 3", "an object of one's own, likewise"),
    ("holdfast run upholding --choose model.json --enough 1", "what likely holds first, until one does"),
    ("holdfast run upholding --resume", "go on where it was interrupted"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to the command's parser."""
    add_task(parser)
    search = parser.add_argument_group("what is looked for")
    add_search(search, 120.0, rounds=True)
    add_wanted(search)
    add_clearance(search)
    add_choose(search)
    add_object(parser, "as few as can carry it, and one more, in turn")
    folder = parser.add_argument_group("what is done, and where it goes")
    folder.add_argument("--out", type=folder_target, metavar="DIR", help="the run folder (runs/<task>)")
    folder.add_argument(
        "--quick",
        action="store_true",
        help="verdicts alone, no margins and pictures; --resume without it adds them",
    )
    folder.add_argument("--resume", action="store_true", help="continue an interrupted run in the run folder")
    folder.add_argument(
        "--force",
        action="store_true",
        help="replace the run that lies in the run folder, whatever it is, and edited files of a mesh",
    )
    folder.add_argument(
        "--workers",
        type=whole_number(1),
        metavar="N",
        help="processes that retract and hold (all cores); the result is the same",
    )
    add_cluster(folder)
    add_json(folder)
    add_quiet(folder)
