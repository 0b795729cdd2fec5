"""`holdfast dataset`."""

import argparse
import shlex
from dataclasses import asdict
from pathlib import Path

from .....base.text.console import Console, emit, emit_json
from .....objects.families import FAMILIES
from .....workers import available_cores
from ....dataset import DatasetPlan, make_dataset
from ...interrupt import stop_on_interrupt

__all__ = ["main"]


def main(arguments: argparse.Namespace) -> int:
    """Makes a data set of choices, or goes on with one."""
    console = Console(quiet=arguments.quiet)
    plan = DatasetPlan(
        families=tuple(FAMILIES) if arguments.families is None else arguments.families,
        objects=arguments.objects,
        first_seed=arguments.first_seed,
        references=tuple(arguments.object),
        hands=arguments.hands,
        one_hand=arguments.one_hand,
        candidates=arguments.candidates,
        draws=arguments.draws,
        loads=arguments.loads,
        seed=arguments.seed,
    )
    with stop_on_interrupt(console.say) as should_stop:
        result = make_dataset(
            plan,
            Path(arguments.out),
            workers=arguments.workers or available_cores(),
            licence=arguments.licence,
            command=_command(plan),
            minari=arguments.minari,
            console=console,
            should_stop=should_stop,
        )
        interrupted = should_stop()
    if result.made:
        console.say(f"{result.cpu_s:.0f} s of the processor for {result.made} situations")
    if arguments.json:
        emit_json(arguments.json, asdict(result) | {"out": arguments.out})
    if arguments.json != "-":
        emit(f"{arguments.out}: {result}")
    return 130 if interrupted and not result.complete else 0


def _command(plan: DatasetPlan) -> str:
    """The command that makes the same data again, without paths of this machine."""
    words = ["holdfast", "dataset", "--families", ",".join(plan.families), "--objects", str(plan.objects)]
    if plan.first_seed:
        words += ["--first-seed", str(plan.first_seed)]
    for reference in plan.references:
        words += ["--object", Path(reference).name]
    words += ["--hands", ",".join(Path(hand).name for hand in plan.hands)]
    words += ["--one-hand"] if plan.one_hand else []
    words += ["--candidates", str(plan.candidates), "--draws", str(plan.draws)]
    words += ["--loads", ",".join(f"{load:g}" for load in plan.loads), "--seed", str(plan.seed)]
    return shlex.join(words)
