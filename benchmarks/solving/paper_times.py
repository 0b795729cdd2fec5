"""Times the nine tasks of the paper: first certified configuration, and configurations a second.

    ./run bench paper_times [FILE]

FILE holds the published numbers (see `parts/paper_tasks.py`); without it only the two stand-ins run. Times
are of the process, in seconds on one core, after a first solve that loads the compiled code.
"""

import argparse
import time

import numpy as np
from holdfast.objects import Task
from holdfast.solver import SolveResult, Verdict, solve
from parts.paper_tasks import load_paper_tasks, stand_in_tasks

SEEDS = range(10)
CANDIDATES = 200


def timed(task: Task, candidates: int, seed: int) -> tuple[SolveResult, float]:
    started = time.process_time()
    result = solve(task, candidates=candidates, seed=seed, budget_s=30.0)
    return result, time.process_time() - started


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", help="the published numbers")
    options = parser.parse_args()
    tasks = (load_paper_tasks(options.file) if options.file else {}) | stand_in_tasks()
    solve(next(iter(tasks.values())), candidates=2)
    for name, task in tasks.items():
        runs = [timed(task, 1, seed) for seed in SEEDS]
        times = [seconds for _, seconds in runs]
        solved = sum(result.verdict is Verdict.SOLVED for result, _ in runs)
        print(
            f"{name:15} first: {np.median(times):6.3f} s, worst {max(times):6.3f} s, "
            f"solved {solved} of {len(runs)}, most boxes {max(r.boxes for r, _ in runs)}, "
            f"most LPs {max(r.lps for r, _ in runs)}",
            flush=True,
        )
    for name, task in tasks.items():
        if len(task.contacts) == 2:
            result, seconds = timed(task, CANDIDATES, 0)
            print(
                f"{name:15} {len(result.configurations) / seconds:6.0f} configurations a second", flush=True
            )


if __name__ == "__main__":
    main()
