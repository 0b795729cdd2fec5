"""`holdfast best TASK --for GOAL`."""

import argparse
from collections.abc import Callable
from functools import partial
from math import isinf
from typing import Any

from ..... import __version__
from .....base.text.console import Console, emit, emit_json
from .....errors import HoldfastError
from .....objects import load_task
from .....solver import BestFriction, BestLoad, BestWithHand, best_friction, best_load, best_with_hand
from .....workers import available_cores
from ...interrupt import stop_on_interrupt

__all__ = ["main"]

_NEAR_ENOUGH, _NOT_YET = 0, 4


def main(arguments: argparse.Namespace) -> int:
    """Climbs from one side and refutes from the other; exit code 0 where they come near enough."""
    if arguments.resume and not arguments.checkpoint:
        raise HoldfastError("best: --resume needs --checkpoint FILE")
    for_load = arguments.goal == "load"
    if arguments.max_force is not None and not for_load:
        raise HoldfastError("best: --max-force goes with --for load; forces of any size balance or don't")
    console, task = Console(quiet=arguments.quiet), load_task(arguments.task)
    console.say(f"looking for the {'largest load' if for_load else 'least friction'} of {task.name}")
    look: Callable[..., BestFriction | BestLoad | BestWithHand]
    if arguments.with_hand:
        look = partial(best_with_hand, goal=arguments.goal, max_force_N=arguments.max_force)
    else:
        look = partial(best_load, max_force_N=arguments.max_force) if for_load else best_friction
    with stop_on_interrupt(console.say) as should_stop:
        best = look(
            task,
            gap=arguments.gap,
            budget_s=arguments.budget,
            seed=arguments.seed,
            workers=arguments.workers or available_cores(),
            proof=arguments.proof,
            checkpoint=arguments.checkpoint,
            resume=arguments.resume,
            on_progress=lambda now, p: console.pass_by(
                f"  found {now.value:.4f}, {'at most' if for_load else 'refuted'} {now.bound:.4f}, gap "
                f"{now.gap:.1%}; {p.boxes} boxes done, {p.open} open, {p.seconds:.0f} s"
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


def _as_json(best: BestFriction | BestLoad | BestWithHand, arguments: argparse.Namespace) -> dict[str, Any]:
    value, bound = ("multiple", "at_most") if arguments.goal == "load" else ("friction", "refuted")
    data = {
        "holdfast": __version__,
        "task": best.task,
        "for": arguments.goal,
        "seed": arguments.seed,
        value: _finite(best.value),
        bound: _finite(best.bound),
        "gap": best.gap,
        **_example(best),
        "boxes": best.progress.boxes,
        "seconds": best.progress.seconds,
        "history": [
            {"seconds": now.seconds, value: _finite(now.value), bound: _finite(now.bound)}
            for now in best.history
        ],
    }
    if isinstance(best, BestWithHand) and best.force_N is not None:
        data |= {"max_force": best.force_N}
    if isinstance(best, BestLoad):
        data |= {"max_force": best.force_N, "in_test_at_most": _finite(best.in_test * best.bound)}
    return data


def _example(best: BestFriction | BestLoad | BestWithHand) -> dict[str, Any]:
    """Points of the regions, or the hand's configuration."""
    if not isinstance(best, BestWithHand):
        return {"params": None if best.example is None else best.example.params.tolist()}
    if best.example is None:
        return {"configuration": None}
    state, hand = best.example.state, best.example.task.hand
    return {
        "configuration": {
            "joints": dict(zip(hand.independent_names, state.q.tolist(), strict=True)),
            "object": {
                "rotation": state.R_palm_object.tolist(),
                "position": state.p_palm_object.tolist(),
            },
            "parameters": state.params.tolist(),
            "certified": best.example.certified,
        }
    }


def _finite(number: float) -> float | None:
    return None if isinf(number) else number
