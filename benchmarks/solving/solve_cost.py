"""What solving costs, against another version: CPU seconds, and whether the same comes of it.

    ./run bench solve_cost --other DIR [--candidates N] [--seeds N ...] [--rounds N] [--json FILE] [TASK ...]

Each task is solved by this version and by the package `holdfast` in the folder DIR, in turns, each time in a
process of its own that has solved it once before, so that nothing is compiled or loaded meanwhile. Of the
rounds the least seconds count. Compared are verdict, boxes, linear programs and all numbers of the
configurations, bit by bit.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from holdfast.base.files.output_file import write_json
from holdfast.base.text.console import format_table
from parts.nine_tasks import TASKS
from parts.places import ABOVE

# What a process does; only names that both versions have.
_SCRIPT = """
import json, sys, time
from holdfast.objects import load_task
from holdfast.solver import solve
task, candidates, seeds = load_task(sys.argv[1]), int(sys.argv[2]), [int(word) for word in sys.argv[3:]]
solve(task, candidates=candidates, seed=seeds[0], budget_s=3600.0)
out = []
for seed in seeds:
    started = time.process_time()
    found = solve(task, candidates=candidates, seed=seed, budget_s=3600.0)
    seconds = time.process_time() - started
    states = [[s.q.tolist(), s.R_palm_object.tolist(), s.p_palm_object.tolist(), s.params.tolist()]
              for s in (c.state for c in found.configurations)]
    out.append([seconds, found.verdict.value, found.progress.boxes, found.lps, len(states), repr(states)])
print(json.dumps(out))
"""


def solved(root: Path, task: str, options: argparse.Namespace) -> tuple[float, list[str]]:
    """CPU seconds of all seeds by the package in a folder, and what came of each, as text."""
    words = [task, str(options.candidates), *map(str, options.seeds)]
    done = subprocess.run(
        [sys.executable, "-P", "-c", _SCRIPT, *words],
        env={**os.environ, "PYTHONPATH": str(root)},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    found = json.loads(done.stdout.splitlines()[-1])
    told = [f"{v}, {n} found, {b} boxes, {p} programs, {_digest(s)}" for _, v, b, p, n, s in found]
    return sum(one[0] for one in found), told


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", metavar="TASK", help="tasks or family members (the nine)")
    parser.add_argument("--other", type=Path, metavar="DIR", required=True, help="of the other package")
    parser.add_argument("--candidates", type=int, default=16)
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json", type=Path, help="file for the figures")
    options = parser.parse_args()
    roots = {"here": ABOVE, "other": options.other.resolve()}
    figures: dict[str, dict[str, object]] = {}
    rows = []
    for task in options.tasks or TASKS:
        seconds = dict.fromkeys(roots, np.inf)
        told: dict[str, list[str]] = {}
        for _ in range(options.rounds):
            for name, root in roots.items():
                one, told[name] = solved(root, task, options)
                seconds[name] = min(seconds[name], one)
        same = told["here"] == told["other"]
        figures[task] = {**seconds, "same": same, "came_of_it": told}
        ratio = seconds["here"] / seconds["other"]
        rows.append(
            [task, *(f"{seconds[name]:.3f}" for name in roots), f"{ratio:.2f}", "same" if same else "differs"]
        )
        print("  ".join(rows[-1]), flush=True)
        if not same:
            print(f"  here {told['here']}\n  other {told['other']}")
        if options.json:
            write_json(options.json, figures)
    print(format_table(["task", "here, CPU s", "other", "ratio", "configurations"], rows))
    print(f"median ratio {np.median([float(row[3]) for row in rows]):.2f}")


if __name__ == "__main__":
    main()
