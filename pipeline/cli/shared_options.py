"""Options that several commands have, with one meaning and one wording."""

import argparse
from typing import Any

from ...base.text.console import Console
from .converters import clearance, positive, whole_number
from .targets import file_target, file_target_or_stdout, folder_target

__all__ = [
    "add_address",
    "add_choose",
    "add_clearance",
    "add_cluster",
    "add_contacts",
    "add_grasp",
    "add_json",
    "add_mesh",
    "add_object",
    "add_quiet",
    "add_renamed",
    "add_search",
    "add_sharing",
    "add_task",
    "add_tree",
    "add_units",
    "add_wanted",
]


def add_task(parser: argparse.ArgumentParser) -> None:
    """The task, or an object in its place."""
    parser.add_argument(
        "task",
        metavar="TASK",
        help="a built-in task (see `holdfast tasks`) or the path of a task file; for run and solve, an "
        "object or a mesh, on which contacts are then looked for",
    )


def add_grasp(parser: argparse.ArgumentParser) -> None:
    """A grasp file, and the task that it is of."""
    parser.add_argument("grasp", metavar="GRASP", help="a grasp file, such as runs/upholding/grasps/g01.json")
    parser.add_argument(
        "--task", metavar="TASK", help="take this task in place of the one that the file names"
    )


def add_quiet(parser: argparse._ActionsContainer) -> None:
    """Silence on stderr."""
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")


def add_json(parser: argparse._ActionsContainer) -> None:
    """The result for programs."""
    parser.add_argument(
        "--json",
        type=file_target_or_stdout,
        metavar="FILE",
        help="write the result as JSON; - writes it to stdout, alone",
    )


def add_search(parser: argparse._ActionsContainer, budget: float, *, rounds: bool = False) -> None:
    """What every search for configurations is told.

    Args:
        parser: or a group of it.
        budget: time in s unless given.
        rounds: whether there may be several searches.
    """
    candidates = "configurations to look for" + (" in each round of the solver" if rounds else "")
    parser.add_argument(
        "--hand",
        metavar="HAND",
        help="take this hand in place of the task's own: a built-in one, or the path of a hand file",
    )
    parser.add_argument(
        "--candidates", type=whole_number(1), default=16, metavar="N", help=f"{candidates} (16)"
    )
    parser.add_argument("--seed", type=whole_number(0), default=0, metavar="N", help="random seed (0)")
    parser.add_argument(
        "--sigma",
        type=positive,
        default=0.1,
        metavar="WIDTH",
        help="width at which boxes are no longer split (0.1)",
    )
    parser.add_argument(
        "--budget",
        type=positive,
        default=budget,
        metavar="SECONDS",
        help=f"wall-clock time after which nothing new is begun ({budget:g})",
    )


def add_wanted(parser: argparse._ActionsContainer) -> None:
    """After how many grasps that hold the solver rests, and after how many the tests do."""
    count = parser.add_mutually_exclusive_group()
    count.add_argument(
        "--wanted",
        type=whole_number(0),
        metavar="N",
        help="grasps that should hold before the solver is no longer asked for more candidates "
        "(5, or as many as --candidates); 0 for one round",
    )
    count.add_argument(
        "--enough",
        type=whole_number(1),
        metavar="N",
        help="as --wanted, and once so many hold, the others are not tested; --resume --wanted N tests them",
    )


def add_choose(parser: argparse._ActionsContainer) -> None:
    """A model that says which grasps are tested first."""
    parser.add_argument(
        "--choose",
        metavar="MODEL",
        help="test those grasps first that a model of `holdfast choose train` chooses",
    )


def add_address(parser: argparse._ActionsContainer) -> None:
    """Where a page in the browser is served."""
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS", help="to listen at (127.0.0.1: this machine alone)"
    )
    parser.add_argument(
        "--port",
        type=whole_number(0),
        default=8080,
        metavar="N",
        help="to listen at, or the next free one (8080)",
    )


def add_units(parser: argparse._ActionsContainer) -> None:
    """What one unit of a mesh's coordinates is."""
    parser.add_argument("--scale", type=positive, metavar="X", help="factor on the mesh's coordinates (1)")
    parser.add_argument("--units", metavar="UNIT", help="their unit: m, cm, mm, in or ft (m)")


def add_mesh(parser: argparse.ArgumentParser, what: str) -> argparse._ArgumentGroup:
    """Options that go with a mesh in place of `what`."""
    mesh = parser.add_argument_group(f"where {what} is a mesh file")
    mesh.add_argument("--mass", type=positive, metavar="KG", help="mass of the object (that of 500 kg/m^3)")
    mesh.add_argument("--friction", type=positive, metavar="MU", help="its coefficient of friction (0.6)")
    add_units(mesh)
    return mesh


def add_contacts(parser: argparse._ActionsContainer, usual: str) -> None:
    """How many contacts are looked for; `usual` says how many there are unless given."""
    parser.add_argument(
        "--contacts",
        type=whole_number(2),
        metavar="N",
        help=f"pairs of regions that touch, which are looked for ({usual})",
    )


def add_object(parser: argparse.ArgumentParser, usual_contacts: str) -> None:
    """Options that go with a mesh, or with an object, in place of TASK."""
    add_mesh(parser, "TASK")
    group = parser.add_argument_group("where TASK is an object or a mesh file")
    add_contacts(group, usual_contacts)
    group.add_argument(
        "--save", type=folder_target, metavar="DIR", help="folder for the object and task files, to edit"
    )


def add_tree(parser: argparse._ActionsContainer, usual_order: str) -> None:
    """How the tree of boxes is searched."""
    parser.add_argument(
        "--order",
        choices=("depth", "breadth", "best"),
        metavar="ORDER",
        help=f"which box comes next: depth, breadth or best first ({usual_order})",
    )
    add_sharing(parser)


def add_sharing(parser: argparse._ActionsContainer) -> None:
    """Who searches a tree, and where its state is kept."""
    parser.add_argument(
        "--workers",
        type=whole_number(1),
        metavar="N",
        help="processes to use; the result is the same for any number (as many as there are cores)",
    )
    parser.add_argument(
        "--checkpoint",
        type=file_target,
        metavar="FILE",
        help="keep the state of the search in this file, every few seconds",
    )
    parser.add_argument("--resume", action="store_true", help="go on from the checkpoint, if there is one")
    add_cluster(parser)


def add_clearance(parser: argparse._ActionsContainer) -> None:
    """How far bodies keep apart."""
    parser.add_argument(
        "--clearance",
        type=clearance,
        default=0.0,
        metavar="METRES",
        help="distance to keep between bodies that should not touch (0)",
    )
    add_renamed(parser, "--margin", "--clearance", type=clearance)


def add_renamed(parser: argparse._ActionsContainer, old: str, new: str, **more: Any) -> None:
    """An option under the name that it had: it does the same, and says how it is called now."""

    class Renamed(argparse.Action):
        def __call__(
            self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, value: Any, *_: object
        ) -> None:
            Console().say(f"holdfast: note: {old} is called {new} now")
            setattr(namespace, self.dest, self.const if self.nargs == 0 else value)

    dest = new.removeprefix("--").replace("-", "_")
    parser.add_argument(
        old, action=Renamed, dest=dest, default=argparse.SUPPRESS, help=argparse.SUPPRESS, **more
    )


def add_cluster(parser: argparse._ActionsContainer) -> None:
    """A cluster in place of this machine's processes."""
    parser.add_argument(
        "--cluster",
        metavar="ADDRESS",
        help="have it done by a Dask cluster, such as tcp://head:8786 (extra `cluster`)",
    )
