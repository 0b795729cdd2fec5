"""`holdfast run TASK`."""

import argparse
from pathlib import Path
from typing import Any

from .....base.machine.backend import configure
from .....base.text.console import Console, emit, emit_json, format_table
from .....base.text.plain_text import counted
from .....mjcf.hold import passed_word, verdict_word
from .....objects import load_task, names_object, split_reference, with_hand
from .....workers import available_cores
from ....records import GraspRecord, RunRecord, to_json
from ....run import RunSettings, choose_folder, folder_name, free_folder, run_task
from ....run_object import ObjectRun, run_object
from ...interrupt import stop_on_interrupt
from .._chooser import chooser_of
from .._object import check_no_mesh_options, requested

__all__ = ["exit_code", "main", "summary"]

# Of thousands of grasps a terminal shows the best ones; the report has them all.
_MOST_ROWS = 100


def main(arguments: argparse.Namespace) -> int:
    """Runs every stage and prints a table of the grasps, the best first."""
    console = Console(quiet=arguments.quiet)
    configure()
    if names_object(arguments.task):
        return _run_object(arguments, console)
    check_no_mesh_options(arguments, "a task")
    reference = with_hand(arguments.task, arguments.hand)
    task = load_task(reference)
    name = task.name if split_reference(reference)[1] is None else f"{task.name}_{task.hand.name}"
    settings = _settings(arguments)
    folder = Path(arguments.out) if arguments.out else Path("runs") / folder_name(name)
    if not arguments.out and not arguments.force:
        folder = choose_folder(task, folder, settings)
    with stop_on_interrupt(console.say) as should_stop:
        record = run_task(
            reference,
            folder,
            settings,
            resume=arguments.resume,
            force=arguments.force,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    if arguments.json:
        emit_json(arguments.json, {"folder": str(folder), "run": to_json(record)})
    if arguments.json != "-":
        emit(summary(record))
        emit(f"{folder / 'report.html'}")
    return 130 if interrupted else exit_code(record)


def exit_code(record: RunRecord) -> int:
    """0 where a grasp is held, and not narrowly."""
    if record.firm:
        return 0
    return 3 if record.verdict == "infeasible" else 4


def _settings(arguments: argparse.Namespace) -> RunSettings:
    return RunSettings(
        candidates=arguments.candidates,
        seed=arguments.seed,
        sigma=arguments.sigma,
        budget_s=arguments.budget,
        margin_m=arguments.clearance,
        wanted=arguments.wanted,
        enough=arguments.enough,
        workers=arguments.workers or available_cores(),
        quick=arguments.quick,
        chooser=chooser_of(arguments.choose),
    )


def _run_object(arguments: argparse.Namespace, console: Console) -> int:
    """Looks for contacts on an object and tries them in turn; prints what came of each, and what held."""
    request = requested(arguments, arguments.task)
    folder = Path(arguments.out) if arguments.out else Path("runs") / folder_name(request.name)
    if not arguments.out and not arguments.force and not arguments.resume:
        folder = free_folder(folder)
    with stop_on_interrupt(console.say) as should_stop:
        done = run_object(
            request,
            folder,
            _settings(arguments),
            save=Path(arguments.save) if arguments.save else None,
            resume=arguments.resume,
            force=arguments.force,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    if arguments.json:
        emit_json(arguments.json, _as_json(done))
    if arguments.json != "-":
        emit(f"{done}\n")
        shown = [attempt for attempt in done.attempts if attempt.is_held] or list(done.attempts[-1:])
        for attempt in shown:
            emit(summary(attempt.record))
            emit(f"{attempt.folder / 'report.html'}")
    return 130 if interrupted else 0 if done.is_firm else 4


def _as_json(done: ObjectRun) -> dict[str, Any]:
    """Every task that was tried, with the record of its run."""
    return {
        "held": done.held,
        "wanted": done.wanted,
        "files": str(done.folder),
        "attempts": [
            {"folder": str(attempt.folder), "run": to_json(attempt.record)} for attempt in done.attempts
        ],
        "words": str(done),
    }


def summary(record: RunRecord) -> str:
    """The run as a table."""
    passed = passed_word(record.kind)
    count = f"{len(record.good)} of {len(record.grasps)} grasps certified, clear and {passed}"
    seconds = sum(record.seconds.values())
    if record.good:
        narrow = len(record.good) - len(record.firm)
        count += f", {narrow} of them narrowly" if narrow else ""
        different = len(record.different)  # compares every grasp with the others
        count += f", {different} of them different" if different < len(record.good) else ""
        unreachable = sum(grasp.is_unreachable for grasp in record.good)
        count += f", {unreachable} of them unreachable" if unreachable else ""
    verdict = verdict_word(record.verdict, record.kind) + (", narrowly" if record.narrow else "")
    if record.lacks_friction:
        verdict += " (friction: no forces at its regions can hold the load, proved)"
    head = f"{record.task}: {verdict}; {count}; {seconds:.1f} s"
    if not record.complete:
        head += "; incomplete, continue with --resume"
    elif record.quick:
        head += "; verdicts only, continue with --resume and without --quick"
    if left := len(record.left_untested):
        head += f"; {left} left untested, as {record.enough} should be enough"
    if record.choosing is not None:
        head += f"\n{record.choosing.words}"
    if not record.grasps:
        return head
    limit = record.limit
    if limit is not None:
        head += f"\nthe strongest of them by plan: {limit.words}"
        if record.carrying is not None and record.carrying.instead:
            head += f"\ncontacts that would carry it (computed): {', '.join(record.carrying.instead)}"
    measured = ("slip/mm", "turn/deg", "margin", "squeeze/N")
    header = ("grasp", "certified", "clear", "depth/mm", "gap/mm", passed, *measured)
    table = format_table(header, [_row(grasp) for grasp in record.grasps[:_MOST_ROWS]])
    more = len(record.grasps) - _MOST_ROWS
    rest = f"and {counted(more, 'more grasp')}, in the report\n" if more > 0 else ""
    return f"{head}\n\n{table}\n{rest}"


def _row(grasp: GraspRecord) -> tuple[str, ...]:
    hold = grasp.hold
    clearance = grasp.clearance
    return (
        grasp.id,
        "yes" if grasp.certified else "no",
        _clear(grasp),
        f"{1e3 * max(0.0, -clearance.after):.3f}" if clearance else "-",
        f"{1e3 * grasp.gap:.3f}",
        _directions(grasp),
        f"{1e3 * hold.slip:.2f}" if hold and hold.slip is not None else "-",
        f"{57.29578 * hold.rotation:.2f}" if hold and hold.rotation is not None else "-",
        f"{hold.margin:.2f}" if hold and hold.margin is not None else "-",
        f"{max(hold.squeeze.normal_forces, default=0.0):.1f}" if hold and hold.squeeze else "-",
    )


def _clear(grasp: GraspRecord) -> str:
    """How it came to be clear, and whether no clear way was found for the fingers to get there."""
    if grasp.clearance is None:
        return "-"
    return grasp.clearance.status + (", unreachable" if grasp.is_unreachable else "")


def _directions(grasp: GraspRecord) -> str:
    """How many directions were held, and whether that is narrowly held or failed."""
    hold = grasp.hold
    if hold is None or not hold.directions:
        return "-"
    narrowly = " narrowly" if grasp.is_narrow else " near miss" if grasp.is_near_miss else ""
    return f"{hold.held_count}/{len(hold.directions)}{narrowly}"
