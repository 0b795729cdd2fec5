"""What whole runs cost: CPU and wall-clock seconds of `holdfast run`, in full and with --quick.

    ./run bench run_cost [--candidates N] [--seed N] [--workers N] [--quick] [--other DIR] [TASK ...]

Each run is a process of its own; its CPU seconds, user and system, are those of it and its workers, with
start-up, pictures and report. A candidate's are what more candidates cost beyond the first one. With --other
a second version, the package `holdfast` in that folder, makes the same runs in turns with this one, so that
what else the machine does meets both; what differs in their verdicts is printed. Everything should be
compiled before: a first run of each does that.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.pipeline.records import GraspRecord, read_run
from parts.places import ABOVE
from parts.run_options import runs_parser


@dataclass(frozen=True)
class Run:
    """What a run took, and what came of it.

    Attributes:
        cpu_s: of the process and its workers.
        wall_s: from its start to its end.
        verdicts: by grasp, `held`, `narrow` or `failed`.
    """

    cpu_s: float
    wall_s: float
    verdicts: dict[str, str]


def measured(root: Path, task: str, candidates: int, options: argparse.Namespace) -> Run:
    """Runs a task by the package in a folder."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["run", task, "--candidates", str(candidates), "--seed", str(options.seed), "--wanted", "0"]
        words += ["--budget", "36000", "--workers", str(options.workers), "--quiet", "--out", folder + "/run"]
        words += ["--quick"] * options.quick
        before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run(
            [sys.executable, "-P", "-m", "holdfast", *words],
            env={**os.environ, "PYTHONPATH": str(root)},
            capture_output=True,
            text=True,
            check=False,
        )
        wall_s = time.monotonic() - started
        if done.returncode not in (0, 4):
            raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}: {done.stderr[-400:]}")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        record = read_run(Path(folder) / "run" / "run.json")
    return Run(cpu_s, wall_s, {grasp.id: verdict(grasp) for grasp in record.grasps})


def verdict(grasp: GraspRecord) -> str:
    """What became of a grasp, in a word."""
    if not grasp.is_held:
        return "failed"
    return "narrow" if grasp.is_narrow else "held"


def main() -> int:
    parser = runs_parser(__doc__)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="verdicts alone")
    parser.add_argument("--other", type=Path, metavar="DIR", help="folder of another version's package")
    options = parser.parse_args()
    roots = {"here": ABOVE} | ({} if options.other is None else {"other": options.other.resolve()})
    rows, shares = [], {name: [] for name in roots}
    for task in options.tasks:
        runs = {}
        for name, root in roots.items():
            one = measured(root, task, 1, options)
            runs[name] = run = measured(root, task, options.candidates, options)
            each_s = (run.cpu_s - one.cpu_s) / max(1, options.candidates - 1)
            shares[name].append(each_s)
            held = sum(verdict != "failed" for verdict in run.verdicts.values())
            rows.append(
                [
                    task,
                    name,
                    *(f"{seconds:.1f}" for seconds in (run.cpu_s, run.wall_s, one.cpu_s)),
                    f"{each_s:.2f}",
                    f"{held}/{len(run.verdicts)}",
                ]
            )
            print("  ".join(rows[-1]), flush=True)
        if len(runs) > 1 and runs["here"].verdicts != runs["other"].verdicts:
            print(f"  differ: here {runs['here'].verdicts}, other {runs['other'].verdicts}")
    head = ["task", "version", "CPU s", "wall s", "one candidate", "each more", "held"]
    print(format_table(head, rows))
    for name, each in shares.items():
        print(f"{name}: CPU s of one more candidate, median over tasks: {np.median(each):.2f}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
