"""`holdfast system FILE`."""

import argparse
from pathlib import Path
from typing import Any

from .....base.files.json_file import read_json
from .....base.files.library import FILE_SUFFIXES
from .....base.files.yaml_file import read_yaml
from .....base.text.console import Console, emit, emit_json, format_table
from .....base.text.plain_text import counted
from .....errors import HoldfastError
from .....solver import SearchOrder, SolutionBox, SystemResult, solve_system
from .....solver.systems import SystemProblem, system_from_data
from .....workers import available_cores
from ...interrupt import stop_on_interrupt

__all__ = ["main"]

_EXIT = {"complete": 0, "infeasible": 3, "undecided": 4}
_MOST_ROWS = 50
# Beyond so many unknowns the table is turned, with so many solutions side by side.
_MOST_COLUMNS, _FEW_COLUMNS = 10, 5


def main(arguments: argparse.Namespace) -> int:
    """Isolates all real solutions of a polynomial system and prints them."""
    if arguments.resume and not arguments.checkpoint:
        raise HoldfastError("system: --resume needs --checkpoint FILE")

    path = Path(arguments.file)
    read = read_yaml if path.suffix.lower() in FILE_SUFFIXES else read_json
    problem = system_from_data(read(path), str(path))
    console = Console(quiet=arguments.quiet)
    with stop_on_interrupt(console.say) as should_stop:
        result = solve_system(
            problem.equations,
            problem.lower,
            problem.upper,
            sigma=arguments.sigma,
            budget_s=arguments.budget,
            order=SearchOrder(arguments.order or "depth"),
            workers=arguments.workers or available_cores(),
            checkpoint=arguments.checkpoint,
            resume=arguments.resume,
            on_progress=lambda p: console.pass_by(
                f"  {p.found} found, {p.boxes} boxes done, {p.open} open, {p.depth} deep, "
                f"{p.decided:.1%} decided, {p.seconds:.0f} s"
            ),
            should_stop=should_stop,
        )
        interrupted = should_stop()
    if result.abandoned:
        console.say(
            f"{counted(result.abandoned, 'box', 'boxes')} ended every process that worked on them: "
            "left undecided"
        )
    if arguments.json:
        emit_json(arguments.json, _as_json(problem, result))
    if arguments.json != "-":
        _print(problem, result)
    return 130 if interrupted else _EXIT[result.verdict.value]


def _as_json(problem: SystemProblem, result: SystemResult) -> dict[str, Any]:
    out: dict[str, Any] = {
        "verdict": result.verdict.value,
        "solutions": [],
        "undecided": len(result.remaining),
        "seconds": result.seconds,
        "boxes": result.boxes,
        "lps": 0,
        "sigma": result.sigma,
        "decided": result.decided,
    }
    if result.covers:
        out["boxes"] = [_box(problem, box) for box in result.solutions]
        out["processed"] = result.boxes
    else:
        out["solutions"] = [_solution(problem, box) for box in result.solutions]
    out["undecided_boxes"] = [
        {name: [low, high] for name, low, high in zip(problem.names, lower, upper, strict=True)}
        for lower, upper in result.remaining
    ]
    return out


def _solution(problem: SystemProblem, box: SolutionBox) -> dict[str, Any]:
    return {
        "x": dict(zip(problem.names, box.middle.tolist(), strict=True)),
        "radius": box.radius,
        "certified": box.certified,
    }


def _box(problem: SystemProblem, box: SolutionBox) -> dict[str, Any]:
    ends = zip(problem.names, box.lower.tolist(), box.upper.tolist(), strict=True)
    return {"box": {name: [low, high] for name, low, high in ends}, "certified": box.certified}


def _print(problem: SystemProblem, result: SystemResult) -> None:
    kind = "boxes that cover the solution set" if result.covers else "certified solutions"
    undecided = counted(len(result.remaining), "undecided box", "undecided boxes")
    emit(
        f"{result.verdict.value}: {len(result.solutions)} {kind}, {undecided}; "
        f"{counted(result.boxes, 'box', 'boxes')}, {result.seconds:.2f} s"
    )
    if result.covers or not result.solutions:
        return
    emit("\n" + _table(problem.names, result.solutions))


def _table(names: tuple[str, ...], solutions: tuple[SolutionBox, ...]) -> str:
    """A solution a row; where there are many unknowns, an unknown a row."""
    rows = [
        (*(f"{value:.9g}" for value in box.middle), f"{box.radius:.1e}") for box in solutions[:_MOST_ROWS]
    ]
    left = len(solutions) - len(rows)
    head = (*names, "radius")
    if len(names) > _MOST_COLUMNS:
        numbered = [f"solution {k}" for k in range(1, len(rows) + 1)][:_FEW_COLUMNS]
        left = len(solutions) - len(numbered)
        columns = zip(head, *rows[:_FEW_COLUMNS], strict=True)
        head, rows = ("unknown", *numbered), [tuple(column) for column in columns]
    more = f"\n... and {left} more; --json writes all" if left else ""
    return format_table(head, rows) + more
