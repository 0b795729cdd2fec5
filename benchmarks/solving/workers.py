"""Measures workers: two against one on a tree of over 1000 boxes, and configurations a second.

    ./run bench workers [--half-thickness METRES] [--rounds N] [--json FILE]

The tree is that of a plate too thick for index and thumb, made thinner until it takes over 1000 boxes to
refute. Configurations are those of the tasks with two contacts. Runs with one and with two workers
alternate, so that other work on the machine weighs on both; the ratio is that of the fastest runs. CPU time
is that of this process and of its workers together: what it grows by is the price of sharing.
"""

import argparse
import json
import os
import resource
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Contact, ObjectRegion, Task, load_task
from holdfast.solver import SolveResult, Verdict, available_cores, solve

# Configurations asked for, and of what.
CANDIDATES = 1000
TASKS = ("upholding", "tuning", "lid_lifting")
# The tree is to have more boxes than this.
LEAST_BOXES = 1000
THINNER_M = 0.001


def plate(half_thickness_m: float) -> Task:
    """`upholding` with the two faces, 40 mm square, of a plate in place of the scalpel's grips."""
    task = load_task("upholding")
    w, h = 0.02, half_thickness_m
    below = np.array([[[-w, w, -h], [-w, -w, -h]], [[w, w, -h], [w, -w, -h]]])
    above = np.array([[[-w, -w, h], [-w, w, h]], [[w, -w, h], [w, w, h]]])
    faces = [
        ObjectRegion(name, Patch(BezierPatch(net), off_surface=True))
        for name, net in (("below", below), ("above", above))
    ]
    contacts = tuple(Contact(c.hand, face) for c, face in zip(task.contacts, faces, strict=True))
    return replace(task, contacts=contacts)


def large_tree(half_thickness_m: float, budget_s: float) -> Task:
    """A plate that is infeasible, but not in so few boxes; thinner than what was asked for where need be."""
    while True:
        task = plate(half_thickness_m)
        result = solve(task, candidates=1, workers=available_cores(), budget_s=budget_s)
        print(
            f"plate {2000 * half_thickness_m:.0f} mm thick: {result.verdict.value}, {result.boxes} boxes",
            flush=True,
        )
        if result.boxes > LEAST_BOXES or result.verdict is not Verdict.INFEASIBLE:
            return task
        half_thickness_m -= THINNER_M


def cpu_seconds() -> float:
    """Of this process and of those that it started and that have ended."""
    usage = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in usage)


def measure(run: Callable[[int], SolveResult], workers: int) -> tuple[SolveResult, dict[str, float]]:
    began, cpu = time.perf_counter(), cpu_seconds()
    result = run(workers)
    return result, {"seconds": time.perf_counter() - began, "cpu_seconds": cpu_seconds() - cpu}


def compare(name: str, run: Callable[[int], SolveResult], rounds: int) -> dict[str, Any]:
    """Alternates one and two workers; the results must be equal."""
    timed: dict[int, list[dict[str, float]]] = {1: [], 2: []}
    results: list[SolveResult] = []
    for _ in range(rounds):
        for workers, times in timed.items():
            result, seconds = measure(run, workers)
            results.append(result)
            times.append(seconds)
            print(
                f"{name}: {workers} workers, {result.verdict.value}, {len(result.configurations)} found, "
                f"{result.boxes} boxes, {result.lps} LPs, {seconds['seconds']:.2f} s, "
                f"CPU {seconds['cpu_seconds']:.2f} s",
                flush=True,
            )
    counts = {(r.verdict, r.boxes, r.lps, len(r.configurations), r.open) for r in results}
    assert len(counts) == 1, f"{name}: results differ between runs: {counts}"
    best = {workers: min(t["seconds"] for t in times) for workers, times in timed.items()}
    cpu = {workers: min(t["cpu_seconds"] for t in times) for workers, times in timed.items()}
    ratio = best[1] / best[2]
    print(
        f"{name}: two workers {ratio:.2f} times as fast as one; CPU time {cpu[2] / cpu[1]:.2f} times as much"
    )
    return {
        "name": name,
        "boxes": results[0].boxes,
        "lps": results[0].lps,
        "verdict": results[0].verdict.value,
        "configurations": len(results[0].configurations),
        "spread": results[0].spread,
        "seconds": best,
        "cpu_seconds": cpu,
        "ratio": ratio,
    }


def candidates(name: str, rounds: int) -> dict[str, Any]:
    """Many configurations of a task."""
    task = load_task(name)
    solve(task, candidates=2)  # compiles what is not compiled yet
    row = compare(name, lambda workers: solve(task, candidates=CANDIDATES, workers=workers), rounds)
    for workers, seconds in row["seconds"].items():
        a_second = row["configurations"] / seconds
        print(f"{name}: {a_second:.0f} certified and distinct configurations a second, {workers} workers")
    return row


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--half-thickness", type=float, default=0.078, metavar="METRES")
    parser.add_argument("--rounds", type=int, default=2, metavar="N")
    parser.add_argument("--budget", type=float, default=250.0, metavar="SECONDS")
    parser.add_argument("--json", metavar="FILE")
    arguments = parser.parse_args()
    print(f"{available_cores()} cores, load {os.getloadavg()[0]:.1f}")
    rows = [candidates(name, arguments.rounds) for name in TASKS]
    thick = large_tree(arguments.half_thickness, arguments.budget)
    rows.append(
        compare(
            "tree",
            lambda workers: solve(thick, candidates=1, workers=workers, budget_s=arguments.budget),
            arguments.rounds,
        )
    )
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=1), "utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
