"""`holdfast solve TASK`."""

import argparse
from collections.abc import Callable
from typing import Any

from ..... import __version__
from .....base.text.console import Console, emit, emit_json, format_table
from .....base.text.plain_text import counted
from .....errors import HoldfastError
from .....objects import Task, names_object, with_hand
from .....solver import SearchOrder, SolveResult, StaticsResult, best_friction, solve
from .....solver.tasks import TaskRelaxation, explain_infeasible, pad_misfits
from ....records import Solution, to_json
from ...interrupt import stop_on_interrupt
from .._object import check_no_mesh_options, task_of_object
from ._solve_all import find_all
from ._solve_setup import SolveSetup

__all__ = ["main"]

_EXIT = {"solved": 0, "infeasible": 3, "undecided": 4}


def main(arguments: argparse.Namespace) -> int:
    """Runs the solver alone and prints what it found."""
    _check_options(arguments)
    if names_object(arguments.task):
        reference, found = task_of_object(arguments, Console(quiet=arguments.quiet))
        if reference is None:
            emit(str(found))
            return _EXIT["undecided"]
    else:
        check_no_mesh_options(arguments, "a task")
        reference = with_hand(arguments.task, arguments.hand)
    if arguments.all:
        return find_all(arguments, reference)

    setup = SolveSetup(arguments, reference, "solving")
    console, task = setup.console, setup.task
    with stop_on_interrupt(console.say) as should_stop:
        result = solve(
            task,
            candidates=1 if arguments.first else arguments.candidates,
            spread_apart=arguments.spread,
            seed=arguments.seed,
            pure=arguments.pure,
            statics=arguments.statics,
            order=SearchOrder(arguments.order) if arguments.order else None,
            proof=arguments.proof,
            **setup.options("found", should_stop),
        )
        infeasible, friction = result.verdict.value == "infeasible", result.lacks_friction
        hints = [str(m) for m in pad_misfits(task)] if infeasible and not friction else []
        reasons = []
        if arguments.explain is not None and friction:
            console.say("looking for the least friction")
            hints.append(_least_friction(setup, should_stop))
        elif arguments.explain is not None and infeasible:
            console.say("relaxing contacts, limits and regions one at a time")
            reasons = _explain(setup, should_stop)
        interrupted = should_stop()
    if result.abandoned:
        console.say(
            f"{counted(result.abandoned, 'box', 'boxes')} ended every process that worked on them: "
            "left undecided"
        )
    solutions = setup.solutions(result.configurations)
    verdict = result.verdict.value
    if arguments.proof:
        written = verdict == "infeasible"
        console.say(f"{'wrote' if written else 'no proof, so did not write'} {arguments.proof}")
    if arguments.json:
        emit_json(arguments.json, _as_json(task, arguments, result, solutions, hints, reasons))
    if arguments.json != "-":
        _print(task, result, solutions, hints, reasons)
    return 130 if interrupted else _EXIT[verdict]


def _check_options(arguments: argparse.Namespace) -> None:
    if arguments.resume and not arguments.checkpoint:
        raise HoldfastError("solve: --resume needs --checkpoint FILE")
    apart = {
        name: getattr(arguments, name)
        for name in ("first", "pure", "statics", "order", "proof", "explain")
        if arguments.all
    }
    for name, given in apart.items():
        if given:
            raise HoldfastError(f"solve: --all and --{name} can't be combined")


def _as_json(
    task: Task,
    arguments: argparse.Namespace,
    result: SolveResult,
    solutions: list[Solution],
    hints: list[str],
    reasons: list[TaskRelaxation],
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
        "hints": hints,
        "reasons": [_reason(r) for r in reasons],
        "statics": None if result.statics is None else _statics(result.statics),
    }


def _print(
    task: Task,
    result: SolveResult,
    solutions: list[Solution],
    hints: list[str],
    reasons: list[TaskRelaxation],
) -> None:
    emit(
        f"{task.name}: {result.verdict.value}; {counted(len(solutions), 'configuration')}; "
        f"{counted(result.boxes, 'box', 'boxes')}, {counted(result.lps, 'LP')}, {result.seconds:.1f} s"
    )
    if result.statics is not None:
        emit(str(result.statics))
    if solutions:
        header = ("id", "certified", "residual/m", "normals opposed")
        emit("\n" + format_table(header, [_row(s) for s in solutions]))
        if (spread := result.spread) is not None:
            emit(
                f"\nnearest neighbours: joints {spread['joints_smallest']:.2f} apart at least, "
                f"{spread['joints_median']:.2f} in the median; contacts {spread['contacts_smallest']:.2f} "
                f"and {spread['contacts_median']:.2f} of their regions"
            )
    if hints:
        emit("\n" + "\n".join(hints))
    if reasons:
        # What helps comes first; a reader may stop there.
        emit("\n" + "\n".join(map(str, sorted(reasons, key=lambda r: r.verdict.value != "solved"))))


def _explain(setup: SolveSetup, should_stop: Callable[[], bool]) -> list[TaskRelaxation]:

    return list(
        explain_infeasible(
            setup.task,
            budget_s=setup.arguments.explain,
            seed=setup.arguments.seed,
            workers=setup.workers,
            should_stop=should_stop,
        )
    )


def _least_friction(setup: SolveSetup, should_stop: Callable[[], bool]) -> str:
    """How much friction would do, as far as is known."""
    arguments = setup.arguments
    return str(
        best_friction(
            setup.task,
            budget_s=arguments.explain,
            seed=arguments.seed,
            workers=setup.workers,
            should_stop=should_stop,
        )
    )


def _statics(statics: StaticsResult) -> dict[str, Any]:
    return {
        "verdict": statics.verdict.value,
        "friction": statics.friction,
        "refuted": statics.refuted,
        "boxes": statics.progress.boxes,
        "seconds": statics.progress.seconds,
    }


def _reason(relaxation: TaskRelaxation) -> dict[str, str]:
    return {
        "kind": relaxation.kind.value,
        "name": relaxation.name,
        "change": relaxation.change,
        "verdict": relaxation.verdict.value,
    }


def _row(solution: Solution) -> tuple[str, ...]:
    certified = "yes" if solution.certified else "no"
    return solution.id, certified, f"{solution.residual:.1e}", _opposed(solution)


def _opposed(solution: Solution) -> str:
    """How well the normals of the solution that is proved are opposed, of the worst contact."""
    angles = [c.opposed_within_deg for c in solution.contacts if c.opposed_within_deg is not None]
    if not angles:
        return "-"
    return "exactly" if max(angles) == 0.0 else f"within {max(angles):.1e} deg"
