"""How near to the limit statics decides whether regions can hold a load: friction twins of many tasks.

    benchmarks/stable.py --json stable.json

Each task, and tasks made of parts of its regions, has a least friction mu* with which forces at points of its
regions balance. It is taken from many local searches, apart from the program that is measured. Twins with 10,
5 and 2 % less should be refuted, and such with as much more solved. Then `best` is asked for mu* itself, with
a proof, and for the largest load with 30 N a contact. Every log is replayed by `check_proof`, and random
points are tried at the bound. With `--goals hand` the least friction with the task's hand is asked for, with
`--goals hand-load` the largest load, of tasks with whole regions, and held against so many restarts of local
search along the contacts, from configurations of other seeds (`--hand-starts`). Seconds are of the processor,
budgets of the clock; the linear algebra of local search keeps to one thread where OPENBLAS_NUM_THREADS=1 is
set.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.base.files.output_file import write_json
from holdfast.check_proof import check_proof
from holdfast.geometry import Patch
from holdfast.objects import LiftTest, ObjectRegion, Task, load_task
from holdfast.solver import (
    Verdict,
    best_friction,
    best_load,
    best_with_hand,
    hand_form,
    load_form,
    refute_balance,
    solve,
    statics_form,
    why_no_load,
    why_not,
)
from holdfast.solver.reach import BestWithHand
from holdfast.solver.reach.climb import HandClimber
from holdfast.solver.reach.objectives import MinusCarried, NeededFriction
from holdfast.solver.statics.climb import Climber
from holdfast.solver.statics.load.climb import LoadClimber
from holdfast.solver.statics.load.problem import load_problem
from holdfast.solver.statics.problem import statics_problem

SHARES = (0.9, 0.95, 0.98, 1.02, 1.05, 1.1)
# Name, share of each region that is kept, and seeds of where it lies; six directions for all.
TASKS = {
    "upholding": (1.0, 0.5), "handling": (1.0, 0.5), "incision": (0.15, 0.25), "lid_lifting": (0.5, 0.3),
    "service": (0.3, 0.4), "transportation": (1.0, 0.3), "holding": (1.0, 0.2),
    "family:mug:31": (0.2,), "family:bottle:5": (0.2,), "family:box:3": (0.2,), "family:cylinder:4": (0.2,),
    "family:handle:2": (0.2,), "family:mug:8": (0.15,),
}  # fmt: skip
_SEEDS = (0, 1)
# With less friction than this there is nothing to refute that anybody would ask about.
_LEAST = 0.02
# For the load: largest normal force of each contact.
_FORCE_N = 30.0
HAND_GOALS = {"friction": "hand", "load": "hand-load"}
GOALS = ("friction", "load", *HAND_GOALS.values())
# Configurations of a seed from which local search restarts; the program under test has the first seed.
_CONFIGURATIONS, _FIRST_SEED = 16, 1000


def part_of(task: Task, width: float, seed: int) -> Task:
    """The task with a part of each region, so wide in both parameters, tested in six directions."""
    rng = np.random.default_rng(seed)
    contacts = []
    for contact in task.contacts:
        region = contact.object.region
        assert isinstance(region, Patch)
        u, v = rng.uniform(0.0, 1.0 - width, size=2) if width < 1.0 else (0.0, 0.0)
        patch = Patch(region.patch.restrict((u, u + width), (v, v + width)), off_surface=True)
        contacts.append(replace(contact, object=ObjectRegion(contact.object.name, patch)))
    return replace(task, contacts=tuple(contacts), test=LiftTest(parts=task.test.parts))


def variants() -> Iterator[tuple[str, Task]]:
    """All tasks by name."""
    for name, widths in TASKS.items():
        base = load_task(name)
        for width in widths:
            for seed in _SEEDS if width < 1.0 else _SEEDS[:1]:
                label = name if width == 1.0 else f"{name}/{width:g}/{seed}"
                yield label, part_of(base, width, seed)


def limit(task: Task, starts: int) -> float:
    """The least friction of many local searches from anywhere."""
    climber, rng = Climber(statics_problem(task)), np.random.default_rng(12345)
    return min(climber.climb(*climber.random(rng)).friction for _ in range(starts))


def measure(task: Task, budget_s: float, folder: Path, starts: int, samples: int) -> dict[str, Any]:
    """What became of a task's twins, and of its least friction."""
    started = time.process_time()
    mu = limit(task, starts)
    row: dict[str, Any] = {
        "contacts": len(task.contacts), "limit": mu, "limit_seconds": _since(started), "twins": {},
    }  # fmt: skip
    if mu < _LEAST:
        return row
    for share in SHARES:
        row["twins"][str(share)] = _twin(task, share * mu, budget_s, folder)
    row["best"] = _best(task, budget_s, folder, samples)
    row["best"]["worse_than_restarts"] = row["best"]["friction"] / mu - 1.0
    return row


def _twin(task: Task, friction: float, budget_s: float, folder: Path) -> dict[str, Any]:
    started, proof = time.process_time(), folder / "twin.proof"
    proof.unlink(missing_ok=True)
    result = refute_balance(task, friction=friction, budget_s=budget_s, proof=proof)
    twin = {
        "verdict": result.verdict.value, "seconds": _since(started), "boxes": result.progress.boxes,
    }  # fmt: skip
    if result.verdict is Verdict.INFEASIBLE:
        started = time.process_time()
        twin["replayed"] = check_proof(proof, statics_form(task)).accepted
        twin["replay_seconds"] = _since(started)
    return twin


def _best(task: Task, budget_s: float, folder: Path, samples: int) -> dict[str, Any]:
    started, proof = time.process_time(), folder / "best.proof"
    proof.unlink(missing_ok=True)
    best = best_friction(task, budget_s=budget_s, proof=proof)
    seconds = _since(started)
    climber, rng = Climber(statics_problem(task)), np.random.default_rng(99)
    beaten = sum(climber.balances(*climber.random(rng), best.bound) for _ in range(samples))
    return {
        "friction": best.value, "refuted": best.bound, "gap": best.gap, "seconds": seconds,
        "boxes": best.progress.boxes, "samples": samples, "samples_that_beat_the_bound": beaten,
        "replayed": best.proof_written and check_proof(proof, statics_form(task)).accepted,
        "history": [[now.seconds, now.value, now.bound] for now in best.history],
    }  # fmt: skip


def largest_load(task: Task, budget_s: float, folder: Path, samples: int) -> dict[str, Any]:
    """The largest load, and whether random points beat the bound."""
    started, proof = time.process_time(), folder / "load.proof"
    proof.unlink(missing_ok=True)
    best = best_load(task, max_force_N=_FORCE_N, budget_s=budget_s, proof=proof)
    seconds = _since(started)
    climber = LoadClimber(load_problem(task, max_force_N=_FORCE_N))
    rng, beaten = np.random.default_rng(99), 0
    for _ in range(samples):
        point = climber.random(rng)
        about, _ = climber.least_twist(*point, enough=best.bound)
        beaten += about > best.bound and climber.carried(*point)[0] > best.bound
    row = {
        "contacts": len(task.contacts), "multiple": best.value,
        "at_most": _finite(best.bound), "gap": best.gap,
        "seconds": seconds, "wall_seconds": best.progress.seconds, "boxes": best.progress.boxes,
        "samples": samples, "samples_that_beat_the_bound": beaten,
        "history": [[now.seconds, now.value, now.bound] for now in best.history if now.bound < np.inf],
    }  # fmt: skip
    if best.proof_written:
        started = time.process_time()
        row["replayed"] = check_proof(proof, load_form(task)).accepted
        row["replay_seconds"] = _since(started)
    return row


def with_hand(task: Task, goal: str, options: argparse.Namespace, folder: Path) -> dict[str, Any]:
    """The best with the hand, and what restarts of local search from elsewhere come to.

    Args:
        task: the task.
        goal: `friction` or `load`.
        options: budget in s, gap and number of restarts.
        folder: for the log.
    """
    started, proof = time.process_time(), folder / "hand.proof"
    proof.unlink(missing_ok=True)
    force_N = None if goal == "friction" else _FORCE_N
    best = best_with_hand(
        task, goal, max_force_N=force_N, gap=options.gap, budget_s=options.budget, proof=proof
    )
    row = {
        "contacts": len(task.contacts), "value": best.value, "bound": _finite(best.bound),
        "gap": best.gap, "seconds": _since(started), "wall_seconds": best.progress.seconds,
        "boxes": best.progress.boxes,
    }  # fmt: skip
    if best.proof_written:
        form = statics_form(task) if goal == "friction" else load_form(task)
        row["replayed"] = check_proof(proof, form | {"hand": hand_form(task)}).accepted
    return row | _restarts(task, goal, options, best)


def _restarts(task: Task, goal: str, options: argparse.Namespace, best: BestWithHand) -> dict[str, Any]:
    """What so many climbs come to, each from a configuration of another seed."""
    if goal == "friction":
        least = statics_problem(task)
        climber, sign = HandClimber(task, least, NeededFriction(least)), 1.0
    else:
        most = load_problem(task, max_force_N=_FORCE_N)
        climber, sign = HandClimber(task, most, MinusCarried(most)), -1.0
    costs: list[float] = []
    started, seed = time.process_time(), _FIRST_SEED
    while len(costs) < options.hand_starts:
        count = min(_CONFIGURATIONS, options.hand_starts - len(costs))
        found = solve(task, candidates=count, seed=seed, budget_s=options.budget)
        if not found:
            break
        costs += [climber.climb(configuration.state)[1] for configuration in found]
        seed += 1
    ends = sign * np.array(costs)
    best_end = sign * min(costs, default=np.inf)
    beaten = ends < best.bound if goal == "friction" else ends > best.bound
    return {
        "restarts": len(costs), "restarts_seconds": _since(started), "best_of_restarts": best_end,
        "worse_than_restarts": sign * (best.value / best_end - 1.0) if best_end else None,
        "restarts_that_beat_the_value": int((np.array(costs) < sign * best.value).sum()),
        "restarts_that_beat_the_bound": int(beaten.sum()),
    }  # fmt: skip


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _since(started: float) -> float:
    return round(time.process_time() - started, 3)


def _line(name: str, row: dict[str, Any]) -> str:
    if not row["twins"]:
        return f"{name:26} {row['contacts']} contacts, mu* = {row['limit']:.4f}: nothing to refute"
    twins = ", ".join(f"{s} {t['verdict']} {t['seconds']:.2f} s" for s, t in row["twins"].items())
    best = row["best"]
    return (
        f"{name:26} {row['contacts']} contacts, mu* = {row['limit']:.4f}: {twins}; "
        f"best {best['friction']:.4f}, refuted {best['refuted']:.4f}, gap {best['gap']:.1%}, "
        f"{best['seconds']:.1f} s"
    )


def _load_line(name: str, row: dict[str, Any]) -> str:
    return (
        f"{name:26} {row['contacts']} contacts, load {row['multiple']:.4g}, at most {row['at_most']}, "
        f"gap {row['gap']:.1%}, {row['boxes']} boxes, {row['seconds']:.1f} s, replayed {row.get('replayed')}"
    )


def _hand_line(name: str, goal: str, row: dict[str, Any]) -> str:
    bound = "none" if row["bound"] is None else f"{row['bound']:.4g}"
    return (
        f"{name:26} {goal} with the hand {row['value']:.5g}, bound {bound}, gap {row['gap']:.1%}, "
        f"{row['boxes']} boxes, {row['seconds']:.1f} s; {row['restarts']} restarts: at best "
        f"{row['best_of_restarts']:.5g}, {row['restarts_seconds']:.1f} s, beaten: value by "
        f"{row['restarts_that_beat_the_value']}, bound by {row['restarts_that_beat_the_bound']}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, help="file for the figures")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds for each twin, and for each best")
    parser.add_argument("--starts", type=int, default=60, help="local searches for each limit")
    parser.add_argument("--samples", type=int, default=2000, help="random points tried at each bound")
    parser.add_argument("--tasks", nargs="+", help="only these")
    parser.add_argument("--goals", nargs="+", choices=GOALS, default=GOALS[:2], help="only these")
    parser.add_argument("--gap", type=float, default=0.05, help="asked for with the hand")
    parser.add_argument("--hand-starts", type=int, default=60, help="restarts of local search with the hand")
    options = parser.parse_args()
    figures: dict[str, Any] = {}
    refute_balance(load_task("upholding"), friction=0.1)  # loads compiled code
    with tempfile.TemporaryDirectory() as folder:
        for name, task in variants():
            if options.tasks and name not in options.tasks:
                continue
            figures[name] = {}
            if "friction" in options.goals and not why_not(task):
                figures[name] = measure(task, options.budget, Path(folder), options.starts, options.samples)
                print(_line(name, figures[name]), flush=True)
            if "load" in options.goals and not why_no_load(task):
                row = largest_load(task, options.budget, Path(folder), options.samples)
                figures[name]["load"] = row
                print(_load_line(name, row), flush=True)
            if "/" not in name and not why_not(task):
                for goal, key in HAND_GOALS.items():
                    if key in options.goals:
                        row = with_hand(task, goal, options, Path(folder))
                        figures[name][key] = row
                        print(_hand_line(name, goal, row), flush=True)
            if options.json:
                write_json(options.json, figures)
    if not options.json:
        print(json.dumps(figures, indent=1))


if __name__ == "__main__":
    main()
