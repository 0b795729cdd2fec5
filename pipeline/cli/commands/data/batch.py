"""`holdfast batch TASK...`."""

import argparse
from pathlib import Path

from .....base.machine.backend import configure
from .....base.text.console import Console, emit
from .....base.text.plain_text import counted
from .....errors import InputError
from .....workers import available_cores
from ....batch import BatchFolder, BatchResult, InFolder, Item, items_of, read_list, run_batch
from ....run import RunSettings
from ...interrupt import stop_on_interrupt
from ...wrong_kind import of_another_kind
from .._chooser import chooser_of
from .._object import requested

__all__ = ["main", "say_result"]


def main(arguments: argparse.Namespace) -> int:
    """Runs everything, and says what came of it; 0 where all was run and something held, else 4."""
    console, out = Console(quiet=arguments.quiet), Path(arguments.out)
    configure()
    items = _items(arguments, out, console)
    settings = RunSettings(
        candidates=arguments.candidates,
        seed=arguments.seed,
        sigma=arguments.sigma,
        budget_s=arguments.budget,
        margin_m=arguments.clearance,
        wanted=arguments.wanted,
        enough=arguments.enough,
        chooser=chooser_of(arguments.choose),
        quick=arguments.quick,
    )
    with stop_on_interrupt(console.say) as should_stop:
        result = run_batch(
            items,
            out,
            settings,
            request=requested(arguments, ""),
            workers=arguments.workers or available_cores(),
            limit_s=arguments.limit,
            resume=arguments.resume,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    say_result(result, out)
    return 130 if interrupted else 0 if result.is_whole and result.good else 4


def _items(arguments: argparse.Namespace, out: Path, console: Console) -> list[Item]:
    references = [*arguments.tasks, *(read_list(Path(arguments.list)) if arguments.list else [])]
    if not references and arguments.resume and BatchFolder(out).plan_path.is_file():
        if arguments.hand:
            raise InputError("batch", "--hand", "is in the tasks of the batch that is resumed")
        return BatchFolder(out).planned_items()
    return items_of(
        references, arguments.hand, on_folder=lambda folder, found: _say_folder(folder, found, console)
    )


def _say_folder(folder: str, found: InFolder, console: Console) -> None:
    passed_over = f"; passed over: {found}" if found.others else ""
    console.say(f"{folder}: {len(found.references)} tasks and meshes{passed_over}")


def say_result(result: BatchResult, out: Path) -> None:
    """Prints what came of a batch, and of each task that is not done why."""
    states: dict[str, int] = {}
    for item in result.items:
        outcome = result.outcomes.get(item.name)
        word = "open, continue with --resume" if outcome is None else outcome.verdict
        states[word] = states.get(word, 0) + 1
    outcomes = ", ".join(f"{count} {word}" for word, count in sorted(states.items(), key=lambda s: -s[1]))
    left = f"; {result.left} left untested, as enough hold" if result.left else ""
    emit(
        f"{counted(len(result.items), 'task')}: {outcomes}; "
        f"{counted(result.good, 'grasp')} certified, clear and held{left}"
    )
    for item in result.items:
        outcome = result.outcomes.get(item.name)
        if outcome is not None and outcome.state != "done":
            failed = outcome.state == "failed"
            better = of_another_kind(item.reference, ("task", "mesh")) if failed else None
            emit(f"{item.name}: {outcome.state}: {better or outcome.reason}")
    emit(f"{out / 'index.html'}")
    if result.table is not None:
        emit(f"{out / result.table.name}")
