"""`holdfast batch TASK...`."""

import argparse
from pathlib import Path

from .....backend import configure
from .....console import Console, emit
from .....errors import InputError
from .....workers import available_cores
from ....batch import BatchFolder, BatchResult, Item, items_of, read_list, run_batch
from ....run import RunSettings
from ...interrupt import stop_on_interrupt
from .._mesh import requested

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Runs everything, and says what came of it; 0 where all was run and something held, else 4."""
    console, out = Console(quiet=arguments.quiet), Path(arguments.out)
    configure()
    items = _items(arguments, out)
    settings = RunSettings(
        candidates=arguments.candidates,
        seed=arguments.seed,
        sigma=arguments.sigma,
        budget_s=arguments.budget,
        margin_m=arguments.clearance,
        wanted=arguments.wanted,
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
    _say(result, out)
    return 130 if interrupted else 0 if result.is_whole and result.good else 4


def _items(arguments: argparse.Namespace, out: Path) -> list[Item]:
    references = [*arguments.tasks, *(read_list(Path(arguments.list)) if arguments.list else [])]
    if not references and arguments.resume and BatchFolder(out).plan_path.is_file():
        if arguments.hand:
            raise InputError("batch", "--hand", "is in the tasks of the batch that is resumed")
        return BatchFolder(out).planned_items()
    return items_of(references, arguments.hand)


def _say(result: BatchResult, out: Path) -> None:
    states: dict[str, int] = {}
    for item in result.items:
        outcome = result.outcomes.get(item.name)
        word = "open, continue with --resume" if outcome is None else outcome.verdict
        states[word] = states.get(word, 0) + 1
    counted = ", ".join(f"{count} {word}" for word, count in sorted(states.items(), key=lambda s: -s[1]))
    emit(f"{len(result.items)} tasks: {counted}; {result.good} grasps certified, clear and held")
    for outcome in result.outcomes.values():
        if outcome.state != "done":
            emit(f"{outcome.name}: {outcome.state}: {outcome.reason}")
    emit(f"{out / 'index.html'}")
    if result.table is not None:
        emit(f"{out / result.table.name}")
