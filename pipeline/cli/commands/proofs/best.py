"""`holdfast best TASK --for GOAL`."""

import argparse
from typing import Any

from ..... import __version__
from .....console import Console, emit, emit_json
from .....errors import HoldfastError
from .....objects import load_task
from .....solver import BestFriction, best_friction
from .....workers import available_cores
from ...interrupt import stop_on_interrupt

__all__ = ["main"]

_NEAR_ENOUGH, _NOT_YET = 0, 4


def main(arguments: argparse.Namespace) -> int:
    """Climbs from one side and refutes from the other; exit code 0 where they come near enough."""
    if arguments.resume and not arguments.checkpoint:
        raise HoldfastError("best: --resume needs --checkpoint FILE")
    console, task = Console(quiet=arguments.quiet), load_task(arguments.task)
    console.say(f"looking for the least friction of {task.name}")
    with stop_on_interrupt(console.say) as should_stop:
        best = best_friction(
            task,
            gap=arguments.gap,
            budget_s=arguments.budget,
            seed=arguments.seed,
            workers=arguments.workers or available_cores(),
            proof=arguments.proof,
            checkpoint=arguments.checkpoint,
            resume=arguments.resume,
            on_progress=lambda now, p: console.pass_by(
                f"  found {now.value:.4f}, refuted {now.bound:.4f}, gap {now.gap:.1%}; {p.boxes} boxes done, "
                f"{p.open} open, {p.seconds:.0f} s"
            ),
            should_stop=should_stop,
        )
        interrupted = should_stop()
    if arguments.proof:
        console.say(f"{'wrote' if best.proof_written else 'no proof, so did not write'} {arguments.proof}")
    if arguments.json:
        emit_json(arguments.json, _as_json(best, arguments))
    if arguments.json != "-":
        emit(str(best))
    return 130 if interrupted else _NEAR_ENOUGH if best.gap <= arguments.gap else _NOT_YET


def _as_json(best: BestFriction, arguments: argparse.Namespace) -> dict[str, Any]:
    found = best.example is not None
    return {
        "holdfast": __version__,
        "task": best.task,
        "for": arguments.goal,
        "seed": arguments.seed,
        "friction": best.value if found else None,
        "refuted": best.bound,
        "gap": best.gap,
        "params": best.example.params.tolist() if best.example is not None else None,
        "boxes": best.progress.boxes,
        "seconds": best.progress.seconds,
        "history": [
            {
                "seconds": now.seconds,
                "friction": now.value if now.value < float("inf") else None,
                "refuted": now.bound,
            }
            for now in best.history
        ],
    }
