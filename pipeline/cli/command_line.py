"""The command line: what the user typed, which command does it, and what the exit code says.

Exit codes: 0 found; 2 bad usage or input, with one line on stderr; 3 proved infeasible; 4 neither;
130 interrupted, and what was found is kept.
"""

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

from ... import __version__
from ...compile_clock import when_compiling
from ...console import Console, mend_streams
from ...errors import HoldfastError, InputWarning, suggest
from ...plain_text import one_line, printable, shortened
from ...platform_check import require_supported_platform
from .interrupt import INTERRUPTED, interrupting
from .targets import file_target, file_target_or_stdout, folder_target

__all__ = ["BAD_INPUT", "run_command"]

BAD_INPUT = 2
_LONGEST_ERROR = 1600
# More than this no hand keeps from what it holds.
_MOST_MARGIN_M = 0.1


class UsageError(HoldfastError):
    """Something on the command line that makes no sense."""


class _Parser(argparse.ArgumentParser):
    """A parser that raises where argparse would print its usage and exit."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{self.prog.removeprefix('holdfast ')}: {message}")


def run_command(argv: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code.

    Args:
        argv: the words after `holdfast`; None takes those of this process.
    """
    mend_streams()
    words = _joined(list(sys.argv[1:] if argv is None else argv))
    try:
        require_supported_platform()
        with warnings.catch_warnings():
            if not sys.warnoptions:
                # What libraries warn of is for developers; users are told in our own words.
                warnings.simplefilter("ignore")
            warnings.simplefilter("always", InputWarning)
            warnings.showwarning = _show_warning(warnings.showwarning)
            return _dispatch(words)
    except HoldfastError as error:
        return _complain(str(error))
    except MemoryError:
        return _complain("out of memory")
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _complain(f"{where}{error.strerror or error}")
    except KeyboardInterrupt:
        print("holdfast: interrupted", file=sys.stderr)
        return INTERRUPTED


def _complain(text: str) -> int:
    """Names from a user's file may hold anything; an error is one plain line all the same."""
    with suppress(OSError):  # nobody listens
        print("holdfast:", one_line(shortened(text, _LONGEST_ERROR)), file=sys.stderr)
    return BAD_INPUT


def _show_warning(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Shows warnings about input as a plain line each, once, and others as before."""
    shown: set[str] = set()

    def show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
        if not issubclass(category, InputWarning):
            otherwise(message, category, *where, **more)
        elif str(message) not in shown:
            shown.add(str(message))
            print("holdfast: warning:", printable(str(message)), file=sys.stderr)

    return show


def _joined(words: list[str]) -> list[str]:
    """`objects fit` and `hands new` as one word; `--at` with its point, which may begin with a minus sign."""
    if words[:2] == ["hands", "new"]:
        return ["hands new", *words[2:]]
    if words[:2] != ["objects", "fit"]:
        return words
    joined = ["objects fit"]
    for word in words[2:]:
        if joined[-1] == "--at":
            joined[-1] = f"--at={word}"
        else:
            joined.append(word)
    return joined


def _dispatch(words: list[str]) -> int:
    parser, commands = _build_parser()
    if not words:
        parser.print_help()
        return 0
    if not words[0].startswith("-") and words[0] not in commands:
        raise UsageError(f"unknown command {words[0]!r}{suggest(words[0], commands)}")
    try:
        arguments, unknown = parser.parse_known_args(words)
    except SystemExit as finished:  # --help and --version
        return int(finished.code or 0)
    if unknown:
        source = f"{words[0]}: " if words[0] in commands else ""
        options = [name for name in _options_of(commands.get(words[0], parser)) if name.startswith("--")]
        kind = "option" if unknown[0].startswith("-") else "argument"
        hint = suggest(unknown[0], options) if kind == "option" else ""
        raise UsageError(f"{source}unknown {kind} {unknown[0]!r}{hint}")
    if "module" not in arguments:
        raise UsageError(f"a command is missing{suggest('', commands)}")
    # Each command is imported when it is asked for: MuJoCo, FCL, SciPy and numba take a second or two.
    command: Callable[[argparse.Namespace], int] = import_module(arguments.module, __package__).main
    console = Console(quiet=getattr(arguments, "quiet", False))
    when_compiling(
        lambda: console.say("compiling the inner loops, once after an installation: about a minute")
    )
    try:
        with interrupting():
            return command(arguments)
    finally:
        when_compiling(None)


def _options_of(parser: argparse.ArgumentParser) -> list[str]:
    return [name for action in parser._actions for name in action.option_strings]


def _build_parser() -> tuple[argparse.ArgumentParser, dict[str, argparse.ArgumentParser]]:
    parser = _Parser(
        prog="holdfast",
        description="Grasps with specified contact regions: certified, penetration-free, held in simulation.",
        epilog="exit codes: 0 found, 2 bad usage or input, 3 proved infeasible, 4 neither, 130 interrupted",
        allow_abbrev=False,
    )
    parser.add_argument("-V", "--version", action="version", version=f"holdfast {__version__}")
    group = parser.add_subparsers(metavar="COMMAND", title="commands")
    commands: dict[str, argparse.ArgumentParser] = {}

    def add(name: str, summary: str) -> argparse.ArgumentParser:
        commands[name] = group.add_parser(name, help=summary, description=summary, allow_abbrev=False)
        commands[name].set_defaults(
            command=name, module=f".commands.{name.replace('-', '_').replace(' ', '_')}"
        )
        return commands[name]

    _add_run(add("run", "all stages on a task: solve, retract, squeeze, hold, report"))
    _add_solve(add("solve", "the solver alone: certified configurations, or a proof that there are none"))
    _add_best(add("best", "the least friction with which a task's regions hold its load, with a proof"))
    _add_system(add("system", "all real solutions of a polynomial system in a box, or a proof of none"))
    _add_clear(add("clear", "free a grasp of penetration, keeping its contacts"))
    _add_hold(add("hold", "squeeze a grasp and put it to its test in simulation"))
    _add_render(add("render", "draw a grasp from four sides, and its hold as a filmstrip"))
    _add_show(add("show", "a picture of an object, a hand, a task or a grasp, with its regions"))
    _add_edit(add("edit", "place regions, solve and save a task, in the browser"))
    _add_report(add("report", "write the report of a run anew"))
    _add_suggest(add("suggest", "tasks for an object: regions with force closure that the hand reaches"))
    _add_check_proof(
        add("check-proof", "replay a proof log, or what a grasp file says was proved, in own arithmetic")
    )
    for kind in ("task", "hand", "object"):
        listing = add(f"{kind}s", f"what {kind}s are built in; with a name or a file, its details")
        listing.set_defaults(module=".commands.listing", kind=kind)
        listing.add_argument(
            "name", nargs="?", metavar="NAME", help=f"a built-in {kind}, or the path of a file"
        )
        if kind == "object":
            _add_mesh(listing, "NAME", None)
        if kind == "hand":
            listing.add_argument(
                "--mjcf",
                type=folder_target,
                metavar="DIR",
                help="write it as a folder for plain MuJoCo, with meshes and a scene",
            )
            listing.add_argument("--mirror", action="store_true", help="take its mirror image")
    _add_new(add("hands new", "a hand file to edit, complete, with the contact regions of a model"))
    _add_fit(add("objects fit", "a Bezier patch fitted to the surface of a mesh, as a contact region"))
    return parser, commands


def _add_new(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", type=file_target, metavar="FILE", help="the hand file to write, such as my_hand.yaml"
    )
    parser.add_argument(
        "--model",
        metavar="MODEL",
        help="an MJCF or URDF model in or below the folder of FILE, or a hand to copy (a small example)",
    )
    parser.add_argument("--mirror", action="store_true", help="the hand is the mirror image of it")
    parser.add_argument("--force", action="store_true", help="write over a file that is there")


def _add_fit(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("mesh", metavar="MESH", help="a mesh file, or an object")
    _add_units(parser)
    parser.add_argument(
        "--at", type=_point, required=True, metavar="X,Y,Z", help="a point on the surface or near it, in m"
    )
    parser.add_argument(
        "--radius",
        type=_positive,
        required=True,
        metavar="R",
        help="distance of the patch's corners from its middle, in m",
    )
    parser.add_argument(
        "--degree", type=_degree, default=(3, 3), metavar="N or M,N", help="degree of the patch (3)"
    )
    parser.add_argument("--name", default="region", metavar="NAME", help="of the region")
    _add_json(parser)
    _add_quiet(parser)


def _add_task(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "task",
        metavar="TASK",
        help="a built-in task (see `holdfast tasks`) or the path of a task file; for run and solve or a mesh",
    )


def _add_grasp(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("grasp", metavar="GRASP", help="a grasp file, such as runs/upholding/grasps/g01.json")
    parser.add_argument(
        "--task", metavar="TASK", help="take this task in place of the one that the file names"
    )


def _add_quiet(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")


def _add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--json",
        type=file_target_or_stdout,
        metavar="FILE",
        help="write the result as JSON; - writes it to stdout, alone",
    )


def _add_search(parser: argparse.ArgumentParser, budget: float) -> None:
    parser.add_argument(
        "--hand",
        metavar="HAND",
        help="take this hand in place of the task's own: a built-in one, or the path of a hand file",
    )
    parser.add_argument(
        "--candidates", type=_whole(1), default=16, metavar="N", help="configurations to look for (16)"
    )
    parser.add_argument("--seed", type=_whole(0), default=0, metavar="N", help="random seed (0)")
    parser.add_argument(
        "--sigma",
        type=_positive,
        default=0.1,
        metavar="WIDTH",
        help="width at which boxes are no longer split (0.1)",
    )
    parser.add_argument(
        "--budget",
        type=_positive,
        default=budget,
        metavar="SECONDS",
        help=f"wall-clock time after which nothing new is begun ({budget:g})",
    )


def _add_units(parser: argparse._ActionsContainer) -> None:
    """What one unit of a mesh's coordinates is."""
    parser.add_argument("--scale", type=_positive, metavar="X", help="factor on the mesh's coordinates (1)")
    parser.add_argument("--units", metavar="UNIT", help="their unit: m, cm, mm, in or ft (m)")


def _add_mesh(parser: argparse.ArgumentParser, what: str, contacts: str | None) -> None:
    """Options that go with a mesh in place of `what`; `contacts` says how many there are unless given."""
    mesh = parser.add_argument_group(f"where {what} is a mesh file")
    mesh.add_argument("--mass", type=_positive, metavar="KG", help="mass of the object (that of 500 kg/m^3)")
    mesh.add_argument("--friction", type=_positive, metavar="MU", help="its coefficient of friction (0.6)")
    _add_units(mesh)
    if contacts is None:
        return
    mesh.add_argument(
        "--contacts",
        type=_whole(2),
        metavar="N",
        help=f"pairs of regions that touch, which are looked for ({contacts})",
    )
    mesh.add_argument(
        "--save", type=folder_target, metavar="DIR", help="folder for the object and task files, to edit"
    )


def _add_run(parser: argparse.ArgumentParser) -> None:
    _add_task(parser)
    _add_mesh(parser, "TASK", "as few as can carry it, and one more, in turn")
    parser.add_argument(
        "--wanted",
        type=_whole(0),
        default=5,
        metavar="N",
        help="grasps that should hold before no more are looked for (5); 0 for one round of the solver",
    )
    parser.add_argument("--out", type=folder_target, metavar="DIR", help="the run folder (runs/<task>)")
    _add_search(parser, 120.0)
    _add_margin(parser)
    parser.add_argument(
        "--workers",
        type=_whole(1),
        metavar="N",
        help="processes that retract and hold (all cores); the result is the same",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="verdicts alone, no margins and pictures; --resume without it adds them",
    )
    parser.add_argument("--resume", action="store_true", help="continue an interrupted run in the run folder")
    parser.add_argument(
        "--force",
        action="store_true",
        help="replace the run that lies in the run folder, whatever it is, and edited files of a mesh",
    )
    _add_quiet(parser)


def _add_solve(parser: argparse.ArgumentParser) -> None:
    _add_task(parser)
    _add_mesh(parser, "TASK", "as few as can carry it")
    parser.add_argument("--first", action="store_true", help="stop at the first configuration")
    parser.add_argument(
        "--all",
        action="store_true",
        help="all solutions: each where they are isolated, else boxes no wider than sigma that cover them",
    )
    _add_search(parser, 60.0)
    parser.add_argument(
        "--spread",
        action="store_true",
        help="look for four times as many configurations, and keep those that are far apart",
    )
    parser.add_argument("--pure", action="store_true", help="branch and prune without local search")
    parser.add_argument(
        "--statics",
        action="store_true",
        help="first try to prove that the regions can't hold the load with the object's friction",
    )
    _add_tree(parser, "breadth; depth with --pure")
    parser.add_argument(
        "--proof",
        type=file_target,
        metavar="FILE",
        help="where the task is infeasible, write a proof for `holdfast check-proof`",
    )
    parser.add_argument(
        "--explain",
        type=_positive,
        metavar="SECONDS",
        help="where it is infeasible, relax each contact, limit and region alone, with so much time for each",
    )
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="write each configuration as a grasp file into this folder",
    )
    _add_json(parser)
    _add_quiet(parser)


def _add_best(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("task", metavar="TASK", help="a built-in task, or the path of a task file")
    parser.add_argument(
        "--for",
        dest="goal",
        required=True,
        choices=("friction",),
        help="friction: the least coefficient with which forces at points of the regions carry the load",
    )
    parser.add_argument(
        "--gap", type=_share, default=0.02, metavar="SHARE", help="stop where the proof is so near (0.02)"
    )
    parser.add_argument(
        "--budget", type=_positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    parser.add_argument("--seed", type=_whole(0), default=0, metavar="N", help="of the local search (0)")
    parser.add_argument(
        "--proof",
        type=file_target,
        metavar="FILE",
        help="write a proof of what is refuted, for `holdfast check-proof`",
    )
    _add_sharing(parser)
    _add_json(parser)
    _add_quiet(parser)


def _add_tree(parser: argparse.ArgumentParser, usual_order: str) -> None:
    """How the tree of boxes is searched."""
    parser.add_argument(
        "--order",
        choices=("depth", "breadth", "best"),
        help=f"which box comes next: depth, breadth or best first ({usual_order})",
    )
    _add_sharing(parser)


def _add_sharing(parser: argparse.ArgumentParser) -> None:
    """Who searches a tree, and where its state is kept."""
    parser.add_argument(
        "--workers",
        type=_whole(1),
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


def _add_system(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="a system file: variables with intervals, and equations")
    parser.add_argument(
        "--sigma",
        type=_positive,
        metavar="WIDTH",
        help="width at which boxes are no longer split (1e-7; 0.05 for fewer equations than unknowns)",
    )
    parser.add_argument(
        "--budget", type=_positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    _add_tree(parser, "depth")
    _add_json(parser)
    _add_quiet(parser)


def _add_margin(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--margin",
        type=_margin,
        default=0.0,
        metavar="METRES",
        help="distance to keep between bodies that should not touch (0)",
    )


def _add_clear(parser: argparse.ArgumentParser) -> None:
    _add_grasp(parser)
    _add_margin(parser)
    parser.add_argument("--all", action="store_true", help="show all pairs of bodies, not the nearest alone")
    parser.add_argument("--out", type=file_target, metavar="FILE", help="write the grasp as it is then")
    _add_json(parser)


def _add_hold(parser: argparse.ArgumentParser) -> None:
    _add_grasp(parser)
    parser.add_argument(
        "--preset",
        default="holdfast",
        metavar="NAME",
        help="holdfast, dexgraspbench, dexonomy, dexgraspnet, multidex or graspqp; all to compare (holdfast)",
    )
    parser.add_argument(
        "--directions",
        metavar="SET",
        help="of gravity, in place of the preset's: task (the task's own), six, or sphere (26)",
    )
    parser.add_argument(
        "--margin", action="store_true", help="search for the multiple of the load at which it first fails"
    )
    parser.add_argument(
        "--agree", action="store_true", help="repeat it at half the time step, with another solver, and so on"
    )
    parser.add_argument(
        "--robust", type=_whole(1), metavar="N", help="repeat it N times with noise of pose and friction"
    )
    parser.add_argument("--seed", type=_whole(0), default=0, metavar="N", help="of the noise (0)")
    parser.add_argument(
        "--out", type=file_target, metavar="FILE", help="write the grasp with the result of the test"
    )
    _add_json(parser)


def _add_render(parser: argparse.ArgumentParser) -> None:
    _add_grasp(parser)
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="folder for the pictures (beside the grasp file, <id>_pictures)",
    )


def _add_show(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "name",
        metavar="NAME",
        help="an object, a hand or a task, built in or as a file; a mesh; a grasp file (.json)",
    )
    parser.add_argument(
        "-o", "--out", type=file_target, metavar="FILE", help="the picture, a .png (<name>_shown.png)"
    )
    parser.add_argument(
        "--view",
        metavar="VIEW",
        help="front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees "
        "(two sides that show most regions)",
    )
    _add_mesh(parser, "NAME", None)
    _add_quiet(parser)


def _add_edit(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="a mesh, an object or a task, built in or as a file")
    _add_mesh(parser, "NAME", None)
    parser.add_argument("--hand", metavar="HAND", help="a built-in hand, or a hand file (sa, or the task's)")
    parser.add_argument(
        "--save",
        type=folder_target,
        metavar="DIR",
        help="where tasks are saved (beside the file; <mesh>_task; else here)",
    )
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS", help="to listen at (127.0.0.1: this machine alone)"
    )
    parser.add_argument(
        "--port", type=_whole(0), default=8080, metavar="N", help="to listen at, or the next free one (8080)"
    )
    _add_quiet(parser)


def _add_report(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run", metavar="RUN", help="a run folder, such as runs/upholding")
    parser.add_argument("--out", type=file_target, metavar="FILE", help="where to write (RUN/report.html)")


def _add_suggest(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "object", metavar="OBJECT", help="a built-in object, or the path of an object file or a mesh"
    )
    _add_mesh(parser, "OBJECT", None)
    parser.add_argument(
        "--hand", default="sa", metavar="HAND", help="a built-in hand, or the path of its file"
    )
    parser.add_argument(
        "--contacts",
        type=_whole(2),
        metavar="N",
        help="pairs of regions in each task (as few as can carry the object)",
    )
    parser.add_argument("--count", type=_whole(1), default=5, metavar="N", help="suggestions wanted (5)")
    parser.add_argument("--seed", type=_whole(0), default=0, metavar="N", help="random seed (0)")
    parser.add_argument(
        "--budget", type=_positive, default=60.0, metavar="SECONDS", help="time after which to stop (60)"
    )
    parser.add_argument(
        "--out",
        type=folder_target,
        metavar="DIR",
        help="folder for the task files (beside the object file; else suggestions)",
    )
    _add_json(parser)
    _add_quiet(parser)


def _add_check_proof(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", help="a proof log of `holdfast solve` or `best`, or a grasp file (.json)"
    )
    parser.add_argument("--task", metavar="TASK", help="the task that the log must refute, or of the grasp")
    _add_json(parser)


def _whole(least: int) -> Callable[[str], int]:
    def convert(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least or value > 2**31:
            raise argparse.ArgumentTypeError(f"must be a whole number, at least {least}, not {text!r}")
        return value

    return convert


def _point(text: str) -> tuple[float, ...]:
    try:
        point = tuple(float(part) for part in text.split(","))
    except ValueError:
        point = ()
    if len(point) != 3 or not all(abs(x) < 1e6 for x in point):
        raise argparse.ArgumentTypeError(f"must be three numbers such as 0.01,0,-0.02, not {text!r}")
    return point


def _degree(text: str) -> tuple[int, int]:
    parts = text.split(",")
    if len(parts) > 2 or not all(part in "123456789" and len(part) == 1 for part in parts):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 to 9, or two, not {text!r}")
    return int(parts[0]), int(parts[-1])


def _margin(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= _MOST_MARGIN_M:
        raise argparse.ArgumentTypeError(f"must be a length from 0 to {_MOST_MARGIN_M:g} m, not {text!r}")
    return value


def _share(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1.0:
        raise argparse.ArgumentTypeError(f"must be a share above 0 and below 1, not {text!r}")
    return value


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    # Compared this way round, NaN fails too.
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"must be a number above 0, not {text!r}")
    return value
