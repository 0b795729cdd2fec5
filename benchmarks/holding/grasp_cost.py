"""What grasps cost, against another version: CPU seconds to make, test and measure each, and what comes.

    ./run bench grasp_cost --other DIR [--candidates N] [--seeds N ...] [--rounds N] [--quick] [--json FILE]
                           [TASK ...]

This version and the package `holdfast` in the folder DIR stand ready in a process each, and every grasp is
done by one and then by the other: on a machine that does other work as well, CPU seconds of the same work
differ by a fifth from minute to minute, and this meets both. Of the rounds the least seconds count. Both
solve each task for themselves. Compared are joints and targets, verdicts, margins, least squeezes and other
settings; what differs is printed.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.base.files.output_file import write_json
from holdfast.base.text.console import format_table
from parts.nine_tasks import TASKS
from parts.places import ABOVE

STAGES = ("make", "test", "extras")
# What is compared as it is; joints and targets by how far they are apart.
TOLD = ("refused", "held", "firm", "rule", "margin", "least", "agree")
# What a process does with each line of tasks, seeds and places; only names that both versions have.
_SCRIPT = """
import inspect, json, sys, time
from holdfast.grasping import find_extras, make_grasp
from holdfast.grasping.firm_squeeze import tried_squeeze
from holdfast.mjcf.hold.strain import strain
from holdfast.objects import LiftTest, load_task
from holdfast.solver import solve

def seconds(work):
    started = time.process_time()
    return work(), time.process_time() - started

solved = {}
for line in sys.stdin:
    name, seed, candidates, place, quick = json.loads(line)
    key = name, seed, candidates
    if key not in solved:
        solved[key] = solve(load_task(name), candidates=candidates, seed=seed, budget_s=3600.0).configurations
    if place is None:
        print(json.dumps(len(solved[key])), flush=True)
        continue
    made, make = seconds(lambda: make_grasp(solved[key][place]))
    told = {"make": make}
    if not made:
        told["refused"] = str(made)
    else:
        (grasp, result, leaning), told["test"] = seconds(lambda: tried_squeeze(made.grasp))
        state, lift = made.configuration.state, isinstance(made.configuration.task.test, LiftTest)
        told |= {"where": [*state.q.tolist(), *made.squeeze.targets.tolist()], "held": result.held,
                 "firm": result.held and leaning.is_firm(result), "rule": grasp.squeeze.rule}
        strains = [strain(entry.slip_m, entry.rotation_rad, result.settings) for entry in result.directions]
        # What a version hands on from the test to what is measured then.
        taken = inspect.signature(find_extras).parameters
        handed = {name: getattr(result, name) for name in ("usual", "pressed_N") if name in taken}
        if result.held and not quick:
            extras, told["extras"] = seconds(lambda: find_extras(
                grasp, held=True, settings=result.settings, strains=strains if lift else None,
                margin=True, agreement=True, **handed))
            told |= {"margin": extras.margin, "least": extras.least_squeeze}
            told |= {"agree": extras.agreement.variants}
    print(json.dumps(told), flush=True)
"""


class Version:
    """The package in a folder, at work in a process of its own."""

    def __init__(self, root: Path):
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _SCRIPT],
            env={**os.environ, "PYTHONPATH": str(root)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __call__(self, *asked: Any) -> Any:
        """What comes of a line."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit(f"a version ended at {asked}")
        return json.loads(line)


def differences(here: dict[str, Any], other: dict[str, Any]) -> list[str]:
    """In words, what of two grasps is not the same."""
    said = [
        f"{name} {here.get(name)}, other {other.get(name)}"
        for name in TOLD
        if here.get(name) != other.get(name)
    ]
    if "where" in here and "where" in other:
        apart = float(np.abs(np.subtract(here["where"], other["where"])).max())
        said += [f"joints or targets {apart:.0e} apart"] * (apart > 1e-6)
    return said


def compared(versions: dict[str, Version], name: str, options: argparse.Namespace) -> list[dict[str, Any]]:
    """The grasps of a task, done in turns; seconds by version and stage."""
    found = []
    for seed in options.seeds:
        asked = name, seed, options.candidates
        counts = [version(*asked, None, options.quick) for version in versions.values()]
        for version in versions.values():
            version(*asked, 0, options.quick)  # nothing is loaded or compiled meanwhile
        for place in range(min(counts)):
            told: dict[str, dict[str, Any]] = {}
            for turn in range(options.rounds):
                order = list(versions) if (place + turn) % 2 else list(versions)[::-1]
                for which in order:
                    one = versions[which](*asked, place, options.quick)
                    known = told.setdefault(which, one)
                    known |= {stage: min(known[stage], one[stage]) for stage in STAGES if stage in one}
            said = differences(told["here"], told["other"])
            if said:
                print(f"  {name}, seed {seed}, grasp {place}: {'; '.join(said)}", flush=True)
            found.append(told)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", metavar="TASK", help="tasks or family members (the nine)")
    parser.add_argument("--other", type=Path, metavar="DIR", required=True, help="of the other package")
    parser.add_argument("--candidates", type=int, default=4)
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1])
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="verdicts alone")
    parser.add_argument("--json", type=Path, help="file for the figures")
    options = parser.parse_args()
    versions = {"here": Version(ABOVE), "other": Version(options.other.resolve())}
    figures: dict[str, list[dict[str, Any]]] = {}
    rows, each = [], {name: [] for name in versions}
    for task in options.tasks or TASKS:
        figures[task] = grasps = compared(versions, task, options)
        if not grasps:
            continue
        seconds = {
            name: [float(np.mean([told[name].get(stage, 0.0) for told in grasps])) for stage in STAGES]
            for name in versions
        }
        for name, of_stages in seconds.items():
            each[name].append(sum(of_stages))
        pairs = zip(seconds["here"], seconds["other"], strict=True)
        rows.append([task, str(len(grasps)), *(f"{a:.3f} / {b:.3f}" for a, b in pairs)])
        rows[-1].append(f"{each['here'][-1] / each['other'][-1]:.2f}")
        print("  ".join(rows[-1]), flush=True)
        if options.json:
            write_json(options.json, figures)
    print(
        format_table(
            ["task", "grasps", *(f"{stage}, CPU s: here / other" for stage in STAGES), "ratio"], rows
        )
    )
    for name, of_tasks in each.items():
        print(f"{name}: CPU s a grasp, median of tasks {np.median(of_tasks):.2f}, sum {sum(of_tasks):.2f}")


if __name__ == "__main__":
    main()
