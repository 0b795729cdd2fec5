"""`holdfast solve TASK --all`."""

import argparse
from typing import Any

from .... import __version__
from ....solver import Cover, solve_all
from ...output import emit, emit_json, format_table
from ...records import Solution, to_json
from ..interrupt import stop_on_interrupt
from ._solve_setup import SolveSetup

__all__ = ["find_all"]

_EXIT = {"complete": 0, "infeasible": 3, "undecided": 4}


def find_all(arguments: argparse.Namespace) -> int:
    """Finds all solutions of a task, one by one or as a cover, and prints what is known of them."""
    setup = SolveSetup(arguments, "looking for all solutions of")
    with stop_on_interrupt(setup.console.say) as should_stop:
        cover = solve_all(setup.task, **setup.options("boxes certified", should_stop))
        interrupted = should_stop()
    solutions = setup.solutions(cover.configurations)
    if arguments.json:
        emit_json(arguments.json, _as_json(cover, solutions))
    if arguments.json != "-":
        _print(cover, solutions)
    return 130 if interrupted else _EXIT[cover.verdict.value]


def _as_json(cover: "Cover", solutions: list[Solution]) -> dict[str, Any]:
    return {
        "holdfast": __version__,
        "task": cover.task.name,
        "verdict": cover.verdict.value,
        "isolated": cover.isolated,
        "seconds": cover.seconds,
        "boxes": cover.processed,
        "lps": cover.lps,
        "sigma": cover.sigma,
        "decided": cover.decided,
        "certified_boxes": cover.certified_boxes,
        "undecided_boxes": cover.undecided_boxes,
        "open_boxes": cover.open_boxes,
        "solutions": [to_json(solution) for solution in solutions],
        "names": list(cover.names),
        "cover": [
            {"lower": box.lower.tolist(), "upper": box.upper.tolist(), "certified": box.certified}
            for box in cover.boxes
        ],
    }


def _print(cover: "Cover", solutions: list[Solution]) -> None:
    name, verdict = cover.task.name, cover.verdict.value
    work = f"{cover.processed} boxes, {cover.lps} LPs, {cover.seconds:.1f} s"
    if not cover.isolated:
        emit(
            f"{name}: {verdict}; a cover of {cover.certified_boxes} certified boxes, "
            f"{cover.undecided_boxes} undecided, {cover.open_boxes} open; {cover.decided:.1%} decided; {work}"
        )
        return
    left = f", {cover.undecided_boxes} boxes undecided" if cover.undecided_boxes else ""
    emit(f"{name}: {verdict}; {len(solutions)} isolated solutions{left}; {work}")
    if solutions:
        rows = [(s.id, "yes" if s.certified else "no", f"{s.residual:.1e}") for s in solutions]
        emit("\n" + format_table(("id", "certified", "residual/m"), rows))
