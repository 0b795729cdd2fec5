"""Infeasible twins: how long the proof takes that a task with its regions moved apart has no solution.

    python benchmarks/twins.py FILE [--json OUT] [--budget SECONDS] [--tasks NAME ...]

FILE holds the published numbers (see `paper_tasks.py`). The twin of a task at scale s has its object's
regions moved, not stretched: the centre of each (the mean of its control points) is put s times as far from
the mean of all centres as it was. The limit s* is the largest scale at which a certified configuration was
found, by bisection to 0.5 %; the true limit may be larger. Twins at 1.1, 1.05 and 1.02 s* are then to be
proved infeasible. Seconds are of the process, on one core; budgets are of the clock.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.files import write_json
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Task
from holdfast.solver import Verdict, solve
from paper_tasks import load_paper_tasks

FACTORS = (1.1, 1.05, 1.02)
_ACCURACY = 0.005
_SEEDS = range(2)
_SEARCH_S = 2.0


def twin(task: Task, scale: float) -> Task:
    """The task with its object's regions, which must be patches, moved apart."""
    patches = [c.object.region for c in task.contacts if isinstance(c.object.region, Patch)]
    if len(patches) != len(task.contacts):
        raise ValueError("only patches can be moved apart")
    nets = [patch.patch.control_points for patch in patches]
    centres = np.array([net.reshape(-1, 3).mean(axis=0) for net in nets])
    shifts = (scale - 1.0) * (centres - centres.mean(axis=0))
    contacts = [
        replace(c, object=replace(c.object, region=Patch(BezierPatch(net + shift))))
        for c, net, shift in zip(task.contacts, nets, shifts, strict=True)
    ]
    regions = {c.object.name: c.object.region for c in contacts}
    return replace(
        task,
        contacts=tuple(contacts),
        object=replace(task.object, regions={**task.object.regions, **regions}),
    )


def is_solved(task: Task) -> bool:
    """Whether some seed leads to a certified configuration within its budget."""
    return any(
        solve(task, candidates=1, seed=seed, budget_s=_SEARCH_S).verdict is Verdict.SOLVED for seed in _SEEDS
    )


def limit(task: Task) -> float:
    """The largest scale found to be feasible."""
    low, high = 1.0, 1.25
    while high < 64.0 and is_solved(twin(task, high)):
        low, high = high, 1.25 * high
    while high - low > _ACCURACY * low:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_solved(twin(task, middle)) else (low, middle)
    return low


def measure(task: Task, budget_s: float) -> dict[str, Any]:
    """The limit of a task and what became of its twins beyond it."""
    s = limit(task)
    print(f"{task.name:15} s* = {s:.4f}", flush=True)
    rows = {}
    for factor in FACTORS:
        started = time.process_time()
        result = solve(twin(task, factor * s), candidates=1, budget_s=budget_s)
        seconds = time.process_time() - started
        rows[str(factor)] = {
            "verdict": result.verdict.value, "seconds": round(seconds, 2),
            "boxes": result.boxes, "lps": result.lps, "open": result.open_boxes,
        }  # fmt: skip
        print(
            f"    {factor:5} s*: {result.verdict.value:10} {seconds:6.1f} s, {result.boxes:5} boxes, "
            f"{result.lps:6} LPs, {result.open_boxes} open",
            flush=True,
        )
        if result.verdict is not Verdict.INFEASIBLE:
            break  # nearer to the limit it only gets harder
    return {"limit": round(s, 5), "twins": rows}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", help="the published numbers")
    parser.add_argument("--json", type=Path, help="file for the figures")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds for each twin")
    parser.add_argument("--tasks", nargs="+", help="only these")
    options = parser.parse_args()
    figures = {}
    for name, task in load_paper_tasks(options.file).items():
        if not options.tasks or name in options.tasks:
            figures[name] = measure(task, options.budget)
            if options.json:
                write_json(options.json, figures)


if __name__ == "__main__":
    main()
