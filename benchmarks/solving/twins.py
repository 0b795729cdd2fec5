"""Infeasible twins: how long the proof takes that a task with its regions moved apart has no solution.

    ./run bench twins FILE [--json OUT] [--limits LIMITS] [--budget SECONDS] [--workers N]
                               [--tasks NAME ...]

FILE holds the published numbers (see `parts/paper_tasks.py`, also for the stand-ins of the two tasks without
any). The twin of a task at scale s has its object's regions moved, not stretched: the centre of each (the
mean of its control points) is put s times as far from the mean of all centres as it was. The limit s* is the
largest scale at which a certified configuration was found: from many configurations the scale climbs as far
as it gets, and again from what is found beyond that. The true limit may be larger. Twins at 1.1, 1.05 and
1.02 s* are then to be proved infeasible. To find s* takes much longer than that: with --limits those in
LIMITS are taken from there, and new ones are added to it. Seconds of the clock are reported and those of all
processes; budgets are of the clock. Workers are as many as there are cores unless --workers says otherwise.
"""

import argparse
import json
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.base.files.output_file import write_json
from holdfast.base.numeric.arrays import Array
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import Task
from holdfast.solver import Verdict, solve
from holdfast.solver.contacts.local_search import search_locally
from holdfast.solver.contacts.manifold import ContactManifold
from holdfast.solver.contacts.state import State
from holdfast.solver.tasks.certify import TaskCertifier
from holdfast.workers import available_cores
from parts.paper_tasks import load_paper_tasks, stand_in_tasks
from scipy.optimize import linprog

FACTORS = (1.1, 1.05, 1.02)
# Climbs start from configurations of so many seeds, then from any at these multiples of the best scale.
_FIRST_SEEDS, _SEEDS_BEYOND, _CANDIDATES, _SEARCH_S = 4, 12, 6, 1.0
_AHEAD = (1.02, 1.005, 1.05)
_LARGEST = 64.0
# Of a climb: trust regions (rad, and shares of parameters), the largest and the least rise of a step.
_FIRST_TRUST, _LARGEST_TRUST, _LAST_TRUST = 0.3, 0.5, 1e-5
_LARGEST_RISE, _LEAST_RISE = 0.5, 1e-6
_SHIFT_PER_TURN_M, _LENGTH_M, _DIFFERENCE = 0.1, 0.05, 1e-4
# On the very limit nothing can be certified: so far below it, in shares of the scale, it is tried.
_STEPS_BACK = (1e-4, 1e-3, 3e-3)
_MOST_CERTIFIED = 3


def twin(task: Task, scale: float) -> Task:
    """The task with its object's regions, which must be patches, moved apart."""
    patches = [c.object.region for c in task.contacts if isinstance(c.object.region, Patch)]
    if len(patches) != len(task.contacts):
        raise ValueError("only patches can be moved apart")
    nets = [patch.patch.control_points for patch in patches]
    centres = np.array([net.reshape(-1, 3).mean(axis=0) for net in nets])
    shifts = (scale - 1.0) * (centres - centres.mean(axis=0))
    contacts = [
        replace(c, object=replace(c.object, region=Patch(BezierPatch(net + shift), off_surface=True)))
        for c, net, shift in zip(task.contacts, nets, shifts, strict=True)
    ]
    regions = {c.object.name: c.object.region for c in contacts}
    return replace(
        task,
        contacts=tuple(contacts),
        object=replace(task.object, regions={**task.object.regions, **regions}),
    )


def limit(task: Task) -> float:
    """The largest scale found to be feasible: the best of many climbs, begun again beyond it."""
    low = _best_climb(task, 1.0, _solutions(task, range(_FIRST_SEEDS)))
    while low < _LARGEST:
        for ahead in _AHEAD:
            scale = ahead * low
            beyond = _solutions(twin(task, scale), range(_SEEDS_BEYOND))
            if beyond:
                break
        else:
            return low
        low = _best_climb(task, scale, beyond)
    return low


def _best_climb(task: Task, scale: float, states: list[State]) -> float:
    """The largest certified scale that climbs from certified states at `scale` lead to."""
    climbs = sorted((climb(task, scale, state) for state in states), key=lambda end: -end[0])
    for top, state in climbs[:_MOST_CERTIFIED]:
        for lower in (top * (1.0 - back) for back in _STEPS_BACK):
            certifier = TaskCertifier(twin(task, lower))
            near = search_locally(certifier.manifold, state)
            if near is not None and certifier.certify(near).certified:
                return max(lower, scale)
    return scale


def _solutions(task: Task, seeds: range) -> list[State]:
    """Certified states from several seeds; beyond the first scale one seed that succeeds is enough."""
    found: list[State] = []
    for seed in seeds:
        result = solve(task, candidates=_CANDIDATES, seed=seed, budget_s=_SEARCH_S)
        found += [c.state for c in result.configurations]
        if found and len(seeds) == _SEEDS_BEYOND:
            break
    return found


def climb(task: Task, scale: float, state: State) -> tuple[float, State]:
    """How far up the scale goes from a solution, by linear programs in a trust region; the state there."""
    trust = _FIRST_TRUST
    while trust > _LAST_TRUST:
        manifold = ContactManifold(twin(task, scale))
        step = _upward(task, scale, manifold, state, trust)
        if step is None or step[-1] < _LEAST_RISE:
            break
        above = scale + float(step[-1])
        reached = _reach(ContactManifold(twin(task, above)), manifold.retract(state, step[:-1]))
        if reached is None:
            trust *= 0.35
        else:
            scale, state, trust = above, reached, min(_LARGEST_TRUST, 1.5 * trust)
    return scale, state


def _reach(manifold: ContactManifold, state: State) -> State | None:
    """The solution next to a state."""
    projected = manifold.project(state)
    return projected if projected is not None and manifold.is_feasible(projected) else None


def _upward(task: Task, scale: float, manifold: ContactManifold, state: State, trust: float) -> Array | None:
    """The tangent step with the rise of the scale (n_tangent + 1,) that raises it most, to first order."""
    c, J = manifold.linearise(state)
    g, G = manifold.inequalities(state)
    by_scale = (ContactManifold(twin(task, scale + _DIFFERENCE)).residual(state) - c) / _DIFFERENCE
    n = manifold.n_tangent
    reach = np.full(n, trust)
    reach[manifold.n_q : manifold.n_q + 3] *= _SHIFT_PER_TURN_M
    x = np.concatenate([state.q, state.params])
    low, high = -reach, reach.copy()
    low[manifold.bounded] = np.clip(manifold.lower - x, low[manifold.bounded], 0.0)
    high[manifold.bounded] = np.clip(manifold.upper - x, 0.0, high[manifold.bounded])
    program = linprog(
        np.append(np.zeros(n), -1.0),
        A_ub=np.column_stack([-G, np.zeros(len(g))]), b_ub=np.maximum(g, 0.0),
        A_eq=np.column_stack([J, by_scale]) / _LENGTH_M, b_eq=-c / _LENGTH_M,
        bounds=[*zip(low, high, strict=True), (0.0, _LARGEST_RISE)],
    )  # fmt: skip
    return np.asarray(program.x) if program.success else None


def measure(task: Task, s: float, budget_s: float, workers: int) -> dict[str, Any]:
    """What became of the twins of a task beyond its limit `s`."""
    print(f"{task.name:15} s* = {s:.4f}", flush=True)
    rows = {}
    for factor in FACTORS:
        started, cpu_started = time.perf_counter(), _cpu_s()
        result = solve(twin(task, factor * s), candidates=1, budget_s=budget_s, workers=workers)
        seconds, cpu_seconds = time.perf_counter() - started, _cpu_s() - cpu_started
        rows[str(factor)] = {
            "verdict": result.verdict.value, "seconds": round(seconds, 2),
            "cpu_seconds": round(cpu_seconds, 2), "boxes": result.boxes, "lps": result.lps,
            "open": result.open,
        }  # fmt: skip
        print(
            f"    {factor:5} s*: {result.verdict.value:10} {seconds:6.1f} s, CPU {cpu_seconds:6.1f} s, "
            f"{result.boxes:5} boxes, {result.lps:6} LPs, {result.open} open",
            flush=True,
        )
        if result.verdict is not Verdict.INFEASIBLE:
            break  # nearer to the limit it only gets harder
    return {"limit": s, "twins": rows}


def _cpu_s() -> float:
    """Seconds of this process and of those that it started and that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class KnownLimits:
    """Limits by task, kept in a file where there is one."""

    def __init__(self, path: Path | None):
        self._path = path
        known = path is not None and path.exists()
        self._limits: dict[str, float] = json.loads(path.read_text("utf-8")) if path and known else {}

    def of(self, task: Task) -> float:
        """The limit of a task, found and kept unless it is known."""
        if task.name not in self._limits:
            self._limits[task.name] = limit(task)
            if self._path is not None:
                write_json(self._path, self._limits)
        return self._limits[task.name]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", help="the published numbers")
    parser.add_argument("--json", type=Path, help="file for the figures")
    parser.add_argument("--limits", type=Path, help="file of limits that are known; it is added to")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds for each twin")
    parser.add_argument("--workers", type=int, default=available_cores(), help="processes")
    parser.add_argument("--tasks", nargs="+", help="only these")
    options = parser.parse_args()
    figures, limits = {}, KnownLimits(options.limits)
    tasks = load_paper_tasks(options.file) | stand_in_tasks()
    # Compiled code is loaded before anything is timed.
    solve(twin(tasks["upholding"], _LARGEST), candidates=1, budget_s=options.budget)
    for name, task in tasks.items():
        if not options.tasks or name in options.tasks:
            figures[name] = measure(task, limits.of(task), options.budget, options.workers)
            if options.json:
                write_json(options.json, figures)


if __name__ == "__main__":
    main()
