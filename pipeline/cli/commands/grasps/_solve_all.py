"""`holdfast solve TASK --all`."""

import argparse
from typing import Any

from ..... import __version__
from .....base.text.console import emit, emit_json, format_table
from .....base.text.plain_text import counted
from .....solver import SolutionSet, solve_all
from ....records import Solution, to_json
from ...interrupt import stop_on_interrupt
from ._solve_setup import SolveSetup

__all__ = ["find_all"]

_EXIT = {"complete": 0, "infeasible": 3, "undecided": 4}


def find_all(arguments: argparse.Namespace, reference: str) -> int:
    """Finds all solutions of a task, one by one or as a cover, and prints what is known of them."""
    setup = SolveSetup(arguments, reference, "looking for all solutions of")
    with stop_on_interrupt(setup.console.say) as should_stop:
        found = solve_all(setup.task, **setup.options("boxes certified", should_stop))
        interrupted = should_stop()
    solutions = setup.solutions(found.configurations)
    if arguments.json:
        emit_json(arguments.json, _as_json(found, solutions))
    if arguments.json != "-":
        _print(found, solutions)
    return 130 if interrupted else _EXIT[found.verdict.value]


def _as_json(found: SolutionSet, solutions: list[Solution]) -> dict[str, Any]:
    return {
        "holdfast": __version__,
        "task": found.task.name,
        "verdict": found.verdict.value,
        "isolated": found.isolated,
        "seconds": found.seconds,
        "boxes": found.boxes,
        "lps": found.lps,
        "sigma": found.sigma,
        "decided": found.decided,
        "certified_boxes": found.certified_boxes,
        "undecided_boxes": found.undecided,
        "open_boxes": found.open,
        "solutions": [to_json(solution) for solution in solutions],
        "names": list(found.names),
        "cover": [
            {"lower": box.lower.tolist(), "upper": box.upper.tolist(), "certified": box.certified}
            for box in found.cover
        ],
    }


def _print(found: SolutionSet, solutions: list[Solution]) -> None:
    name, verdict = found.task.name, found.verdict.value
    work = f"{counted(found.boxes, 'box', 'boxes')}, {counted(found.lps, 'LP')}, {found.seconds:.1f} s"
    if not found.isolated:
        emit(
            f"{name}: {verdict}; a cover of "
            f"{counted(found.certified_boxes, 'certified box', 'certified boxes')}, "
            f"{found.undecided} undecided, {found.open} open; {found.decided:.1%} decided; {work}"
        )
        return
    left = f", {counted(found.undecided, 'box', 'boxes')} undecided" if found.undecided else ""
    emit(f"{name}: {verdict}; {len(solutions)} isolated solutions{left}; {work}")
    if solutions:
        rows = [(s.id, "yes" if s.certified else "no", f"{s.residual:.1e}") for s in solutions]
        emit("\n" + format_table(("id", "certified", "residual/m"), rows))
