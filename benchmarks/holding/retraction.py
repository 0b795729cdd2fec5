"""Retraction of 50 spread configurations of each of the nine tasks, beside penalty minimisation.

Usage: ./run bench retraction [TASK ...] [--count N] [--json FILE]

Times are CPU time of one core. A configuration counts as cleared by retraction where no pair of bodies is
deeper than allowed and all contacts hold to 1e-9 m; by penalty minimisation, where no pair is deeper than
allowed and the contacts hold to 1e-6 m, to be generous.
"""

import argparse
import json
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.objects import Task, load_task
from holdfast.retraction import (
    ClearanceComparison,
    ClearConfiguration,
    RetractionFailure,
    RetractionStatus,
    compare_clearance,
    compute_clearance,
    find_approach,
    retract,
)
from holdfast.solver import Configuration, ContactManifold, solve
from parts.nine_tasks import TASKS
from parts.penalty import minimise_penalty

SEED = 0
SOLVER_BUDGET_S = 120.0
# Contacts of the baseline that are further off than this don't hold.
BASELINE_CONTACT_M = 1e-6


@dataclass
class Row:
    """Figures of one task; times in ms of CPU time, lengths in m."""

    task: str
    configurations: int
    colliding: int
    cleared: int
    slid: int
    near: int
    anew: int
    moved_median: float
    certified_before: int
    certified_after: int
    residual: float
    outside_limits: int
    verdicts: int
    verdicts_agreed: int
    distances: int
    distances_agreed: int
    reachable: int
    ms: list[float]
    approach_ms: float
    baseline_cleared: int
    baseline_contact_error: float
    baseline_ms: list[float]
    failures: list[dict[str, object]]


def spread_configurations(task: Task, count: int) -> list[Configuration]:
    """What the solver finds: configurations that differ by 0.1 rad or 10 mm at least."""
    return list(solve(task, candidates=count, seed=SEED, budget_s=SOLVER_BUDGET_S).configurations)


def measure_task(name: str, count: int, with_baseline: bool) -> Row:
    task = load_task(name)
    manifold = ContactManifold(task)
    configurations = spread_configurations(task, count)
    outcomes, times = [], []
    if configurations:
        find_approach(configurations[0])  # code is compiled and bodies are built once
        retract(configurations[0])
    for configuration in configurations:
        started = time.process_time()
        outcomes.append(retract(configuration))
        times.append(1e3 * (time.process_time() - started))
    clear = [outcome for outcome in outcomes if isinstance(outcome, ClearConfiguration)]
    moved = [outcome for outcome in clear if outcome.status is RetractionStatus.RETRACTED]
    failed = [outcome for outcome in outcomes if isinstance(outcome, RetractionFailure)]
    ends = [outcome.configuration for outcome in moved]
    comparisons = [compare_clearance(task, c.state) for c in [*configurations, *ends]]
    started = time.process_time()
    approaches = [find_approach(outcome.configuration) for outcome in clear]
    approach_ms = 1e3 * (time.process_time() - started) / max(len(clear), 1)
    routes = Counter(outcome.route for outcome in moved)
    row = Row(
        task=name,
        configurations=len(configurations),
        colliding=len(moved) + len(failed),
        cleared=len(moved),
        slid=routes["slid"],
        near=routes["near"],
        anew=routes["anew"],
        moved_median=float(np.median([outcome.moved for outcome in moved])) if moved else 0.0,
        certified_before=sum(configuration.certified for configuration in configurations),
        certified_after=sum(configuration.certified for configuration in ends),
        residual=max((float(np.abs(manifold.residual(c.state)).max()) for c in ends), default=0.0),
        outside_limits=sum(not manifold.is_feasible(c.state) for c in ends),
        verdicts=len(comparisons),
        verdicts_agreed=sum(_same_verdict(comparison) for comparison in comparisons),
        distances=sum(len(comparison.fcl.pairs) for comparison in comparisons),
        distances_agreed=sum(len(c.fcl.pairs) - len(c.differing) for c in comparisons),
        reachable=sum(approach.reachable for approach in approaches),
        ms=times,
        approach_ms=approach_ms,
        baseline_cleared=0,
        baseline_contact_error=0.0,
        baseline_ms=[],
        failures=[reason(outcome) for outcome in failed],
    )
    if with_baseline:
        colliding = [o.configuration for o in failed]
        colliding += [
            c for c, o in zip(configurations, outcomes, strict=True) if o.status is RetractionStatus.RETRACTED
        ]
        add_baseline(row, task, manifold, colliding)
    return row


def add_baseline(row: Row, task: Task, manifold: ContactManifold, colliding: list[Configuration]) -> None:
    """Penalty minimisation from the same colliding configurations."""
    errors = []
    for configuration in colliding:
        started = time.process_time()
        state = minimise_penalty(task, manifold, configuration.state)
        row.baseline_ms.append(1e3 * (time.process_time() - started))
        error = float(np.abs(manifold.residual(state)).max())
        errors.append(error)
        holds = error <= BASELINE_CONTACT_M and manifold.is_feasible(state, 1e-6)
        row.baseline_cleared += holds and compute_clearance(task, state).is_clear
    row.baseline_contact_error = float(np.median(errors)) if errors else 0.0


def _same_verdict(comparison: ClearanceComparison) -> bool:
    pairs = zip(comparison.fcl.pairs, comparison.mujoco.pairs, strict=True)
    return all(ours.is_clear == theirs.is_clear for ours, theirs in pairs)


def reason(failure: RetractionFailure) -> dict[str, object]:
    """Why a configuration could not be cleared."""
    return {
        "reason": failure.reason,
        "blocking": [(pair.a, pair.b) for pair in failure.blocking],
        "least_depth": -failure.after_m,
        "active_limits": failure.active_limits,
    }


def table(rows: list[Row]) -> str:
    header = (
        "task", "colliding", "cleared", "slid", "near", "anew", "moved", "certified", "residual/m", "ms",
        "p95/ms", "reachable", "baseline", "its error/m", "its ms",
    )  # fmt: skip
    return format_table(header, [cells(row) for row in rows])


def cells(row: Row) -> tuple[str, ...]:
    ms, p95 = percentiles(row.ms)
    clear = row.configurations - row.colliding + row.cleared
    return (
        row.task,
        f"{row.colliding} of {row.configurations}",
        share(row.cleared, row.colliding),
        str(row.slid),
        str(row.near),
        str(row.anew),
        f"{row.moved_median:.2f}",
        f"{row.certified_after} of {row.cleared}",
        f"{row.residual:.0e}",
        f"{ms:.0f}",
        f"{p95:.0f}",
        f"{row.reachable} of {clear}",
        share(row.baseline_cleared, row.colliding),
        f"{row.baseline_contact_error:.0e}",
        f"{percentiles(row.baseline_ms)[0]:.0f}",
    )


def share(part: int, whole: int) -> str:
    return f"{part} ({100 * part / whole:.0f} %)" if whole else "-"


def percentiles(values: list[float]) -> tuple[float, float]:
    """Median and 95th percentile."""
    median, p95 = np.percentile(values, [50, 95]) if values else (0.0, 0.0)
    return float(median), float(p95)


def summary(rows: list[Row]) -> str:
    colliding, cleared = (sum(getattr(row, name) for row in rows) for name in ("colliding", "cleared"))
    agreed, verdicts = (sum(getattr(row, name) for row in rows) for name in ("verdicts_agreed", "verdicts"))
    same, distances = (sum(getattr(row, name) for row in rows) for name in ("distances_agreed", "distances"))
    median, p95 = percentiles([ms for row in rows for ms in row.ms])
    slid, near, anew = (sum(getattr(row, name) for row in rows) for name in ("slid", "near", "anew"))
    certified, outside = (sum(getattr(row, n) for row in rows) for n in ("certified_after", "outside_limits"))
    residual = max(row.residual for row in rows)
    lines = [
        f"cleared {share(cleared, colliding)} of {colliding}: slid {slid}, near {near}, anew {anew}",
        f"certified after {certified}, outside limits {outside}, worst residual {residual:.1e} m",
        f"FCL and MuJoCo agree on {agreed} of {verdicts} verdicts, {same} of {distances} distances",
        f"CPU time of a configuration: median {median:.0f} ms, 95th percentile {p95:.0f} ms",
    ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tasks", nargs="*", default=TASKS, metavar="TASK")
    parser.add_argument("--count", type=int, default=50, metavar="N", help="configurations of each task (50)")
    parser.add_argument("--no-baseline", action="store_true", help="leave penalty minimisation out")
    parser.add_argument("--json", metavar="FILE", help="write all figures")
    arguments = parser.parse_args()
    rows = []
    for name in arguments.tasks:
        rows.append(measure_task(name, arguments.count, not arguments.no_baseline))
        print(table(rows[-1:]), flush=True)
        for failure in rows[-1].failures[:3]:
            print(f"    {failure}")
        if arguments.json:
            Path(arguments.json).write_text(json.dumps([asdict(row) for row in rows], indent=1), "utf-8")
    print(f"\n{table(rows)}\n\n{summary(rows)}")


if __name__ == "__main__":
    main()
