"""`holdfast solve TASK`."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import __version__
from ...files import write_json
from ..interrupt import stop_on_interrupt
from ..output import Console, emit, emit_json, format_table
from ..records import GraspFile, Solution, to_json

if TYPE_CHECKING:
    from ...objects import Task
    from ...solver import SolveResult
    from ...solver.explain import Relaxation

__all__ = ["main"]

_EXIT = {"solved": 0, "infeasible": 3, "undecided": 4}


def main(arguments: argparse.Namespace) -> int:
    """Runs the solver alone and prints what it found."""
    from ...objects import load_task
    from ...solver import solve
    from ..grasps import to_solution

    console = Console(quiet=arguments.quiet)
    task = load_task(arguments.task)
    console.say(f"solving {task.name}")
    with stop_on_interrupt(console.say) as should_stop:
        result = solve(
            task,
            candidates=1 if arguments.first else arguments.candidates,
            seed=arguments.seed,
            sigma=arguments.sigma,
            budget_s=arguments.budget,
            pure=arguments.pure,
            proof=arguments.proof,
            on_progress=lambda p: console.pass_by(
                f"  {p.found} found, {p.boxes} boxes done, {p.open_boxes} open, {p.seconds:.0f} s"
            ),
            should_stop=should_stop,
        )
        reasons = []
        if arguments.explain is not None and result.verdict.value == "infeasible":
            console.say("relaxing contacts, limits and regions one at a time")
            reasons = _explain(task, arguments, should_stop)
        interrupted = should_stop()
    solutions = [to_solution(c, f"g{i:02d}") for i, c in enumerate(result.configurations, start=1)]
    verdict = result.verdict.value
    if arguments.out:
        _write_grasps(Path(arguments.out), solutions, task, arguments.task)
    if arguments.proof:
        written = verdict == "infeasible"
        console.say(f"{'wrote' if written else 'no proof, so did not write'} {arguments.proof}")
    if arguments.json:
        emit_json(arguments.json, _as_json(task, arguments, result, solutions, reasons))
    if arguments.json != "-":
        _print(task, result, solutions, reasons)
    return 130 if interrupted else _EXIT[verdict]


def _as_json(
    task: "Task",
    arguments: argparse.Namespace,
    result: "SolveResult",
    solutions: list[Solution],
    reasons: list["Relaxation"],
) -> dict[str, Any]:
    return {
        "holdfast": __version__,
        "task": task.name,
        "seed": arguments.seed,
        "verdict": result.verdict.value,
        "seconds": result.seconds,
        "boxes": result.boxes,
        "lps": result.lps,
        "sigma": result.sigma,
        "spread": result.spread,
        "solutions": [to_json(solution) for solution in solutions],
        "reasons": [_reason(r) for r in reasons],
    }


def _print(
    task: "Task", result: "SolveResult", solutions: list[Solution], reasons: list["Relaxation"]
) -> None:
    emit(
        f"{task.name}: {result.verdict.value}; {len(solutions)} configurations; {result.boxes} boxes, "
        f"{result.lps} LPs, {result.seconds:.1f} s"
    )
    if solutions:
        emit("\n" + format_table(("id", "certified", "residual/m"), [_row(s) for s in solutions]))
    if reasons:
        # What helps comes first; a reader may stop there.
        emit("\n" + "\n".join(map(str, sorted(reasons, key=lambda r: r.verdict.value != "solved"))))


def _explain(
    task: "Task", arguments: argparse.Namespace, should_stop: Callable[[], bool]
) -> list["Relaxation"]:
    from ...solver.explain import explain_infeasible

    return list(
        explain_infeasible(task, budget_s=arguments.explain, seed=arguments.seed, should_stop=should_stop)
    )


def _reason(relaxation: "Relaxation") -> dict[str, str]:
    return {
        "kind": relaxation.kind.value,
        "name": relaxation.name,
        "change": relaxation.change,
        "verdict": relaxation.verdict.value,
    }


def _row(solution: Solution) -> tuple[str, str, str]:
    return solution.id, "yes" if solution.certified else "no", f"{solution.residual:.1e}"


def _write_grasps(folder: Path, solutions: list[Solution], task: "Task", reference: str) -> None:
    from ..grasps import file_head

    for solution in solutions:
        path = folder / f"{solution.id}.json"
        head = file_head(task, reference, path)
        write_json(path, to_json(GraspFile.model_validate({**solution.model_dump(), **head})))
