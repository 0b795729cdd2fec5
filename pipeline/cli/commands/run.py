"""`holdfast run TASK`."""

import argparse
from pathlib import Path

from ....backend import configure
from ....console import Console, emit, format_table
from ....errors import InputError
from ....mjcf.hold import passed_word, verdict_word
from ....objects import MESH_FORMATS, load_task, split_reference, with_hand
from ....workers import available_cores
from ...records import GraspRecord, RunRecord
from ...run import RunSettings, run_task
from ...run_object import ObjectSource, run_object
from ..interrupt import stop_on_interrupt

__all__ = ["main"]

_EXIT = {"held": 0, "infeasible": 3}


def main(arguments: argparse.Namespace) -> int:
    """Runs every stage and prints a table of the grasps, the best first."""
    console = Console(quiet=arguments.quiet)
    configure()
    if arguments.task.lower().endswith(MESH_FORMATS):
        return _run_mesh(arguments, console)
    for option in ("mass", "friction", "scale", "units", "contacts", "save"):
        if getattr(arguments, option) is not None:
            raise InputError("run", f"--{option}", "goes with a mesh file; a task has its own")
    reference = with_hand(arguments.task, arguments.hand)
    task = load_task(reference)
    name = task.name if split_reference(reference)[1] is None else f"{task.name}_{task.hand.name}"
    folder = Path(arguments.out) if arguments.out else Path("runs") / folder_name(name)
    with stop_on_interrupt(console.say) as should_stop:
        record = run_task(
            reference,
            folder,
            _settings(arguments),
            resume=arguments.resume,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    emit(summary(record))
    emit(f"{folder / 'report.html'}")
    return 130 if interrupted else _EXIT.get(record.verdict, 4)


def _settings(arguments: argparse.Namespace) -> RunSettings:
    return RunSettings(
        candidates=arguments.candidates,
        seed=arguments.seed,
        sigma=arguments.sigma,
        budget_s=arguments.budget,
        margin_m=arguments.margin,
        workers=arguments.workers or available_cores(),
    )


def _run_mesh(arguments: argparse.Namespace, console: Console) -> int:
    """Looks for contacts on a mesh and tries them in turn; prints the last run and what came of each."""
    if arguments.resume:
        raise InputError("run", "--resume", "goes with a task, such as one that a run of the mesh has saved")
    mesh = Path(arguments.task)
    hand = arguments.hand or "sa"
    name = folder_name(f"{mesh.stem}_{Path(hand).stem}")
    folder = Path(arguments.out) if arguments.out else Path("runs") / name
    source = ObjectSource(
        mesh,
        hand,
        mass_kg=arguments.mass,
        friction=arguments.friction,
        scale=arguments.scale,
        units=arguments.units,
        contacts=arguments.contacts,
    )
    with stop_on_interrupt(console.say) as should_stop:
        done = run_object(
            source,
            folder,
            _settings(arguments),
            save=Path(arguments.save) if arguments.save else None,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    emit(f"{done}\n")
    if done.attempts:
        emit(summary(done.attempts[-1].record))
        emit(f"{folder / 'report.html'}")
    return 130 if interrupted else 0 if done.is_held else 4


def folder_name(task_name: str) -> str:
    """The task's name as the name of a folder: what a path could take for something else becomes `_`."""
    plain = "".join(c if c.isalnum() or c in "-_" else "_" for c in task_name)
    return plain or "_"


def summary(record: RunRecord) -> str:
    """The run as a table."""
    passed = passed_word(record.kind)
    count = f"{len(record.good)} of {len(record.grasps)} grasps certified, clear and {passed}"
    seconds = sum(record.seconds.values())
    head = f"{record.task}: {verdict_word(record.verdict, record.kind)}; {count}; {seconds:.1f} s"
    if not record.complete:
        head += "; incomplete, continue with --resume"
    if not record.grasps:
        return head
    measured = ("slip/mm", "turn/deg", "margin", "squeeze/N")
    header = ("grasp", "certified", "clear", "depth/mm", "gap/mm", passed, *measured)
    return f"{head}\n\n{format_table(header, [_row(grasp) for grasp in record.grasps])}\n"


def _row(grasp: GraspRecord) -> tuple[str, ...]:
    hold = grasp.hold
    clearance = grasp.clearance
    return (
        grasp.id,
        "yes" if grasp.certified else "no",
        clearance.status if clearance else "-",
        f"{1e3 * max(0.0, -clearance.after):.3f}" if clearance else "-",
        f"{1e3 * grasp.gap:.3f}",
        f"{hold.held_count}/{len(hold.directions)}" if hold and hold.directions else "-",
        f"{1e3 * hold.slip:.2f}" if hold and hold.slip is not None else "-",
        f"{57.29578 * hold.rotation:.2f}" if hold and hold.rotation is not None else "-",
        f"{hold.margin:.2f}" if hold and hold.margin is not None else "-",
        f"{max(hold.squeeze.normal_forces, default=0.0):.1f}" if hold and hold.squeeze else "-",
    )
