"""What share of a run goes into statics of the task before any configuration is looked for.

    ./run bench statics_share [--candidates N] [--seed N] [--full] [--json FILE] [TASK ...]

Each run is a process of its own with one worker, in which two steps of a run are timed: what the contacts can
carry, and the proof that the regions can't hold the load. Seconds are of the processor, start-up of the
process left out of the run's. The first compiled function that a process uses, whichever it is, waits for the
start of what loads such functions; a run needs that anyway, so it is made to happen before, with the hand's
kinematics, and counts as the run's (`start`). Runs are brief unless --full is given, so shares are large
rather than small.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from holdfast.base.files.output_file import write_json
from holdfast.base.text.console import format_table
from holdfast.hands import joint_axes
from holdfast.objects import load_task
from holdfast.pipeline.run import RunSettings, rounds, run, run_task
from parts.places import RUN
from parts.run_options import runs_parser

# Steps by name: the module that takes them, and its function.
STEPS = {"carrying": (run, "find_carrying"), "refuting": (rounds, "refuted_by_statics")}


def measured(task: str, settings: RunSettings) -> dict[str, float]:
    """CPU seconds of a run in this process, of the start of compiled code, and of the steps in it."""
    seconds = dict.fromkeys(("run", "start", *STEPS), 0.0)

    def timed(name: str, step: Callable[..., Any]) -> Callable[..., Any]:
        def wrapped(*arguments: Any, **named: Any) -> Any:
            started = time.process_time()
            try:
                return step(*arguments, **named)
            finally:
                seconds[name] += time.process_time() - started

        return wrapped

    for name, (module, function) in STEPS.items():
        setattr(module, function, timed(name, getattr(module, function)))
    hand = load_task(task).hand
    started = time.process_time()
    joint_axes(hand, hand.expand(hand.limits.mean(axis=1)))
    seconds["start"] = time.process_time() - started
    with tempfile.TemporaryDirectory() as folder:
        started = time.process_time()
        run_task(task, Path(folder) / "run", settings)
        seconds["run"] = seconds["start"] + time.process_time() - started
    return seconds


def main() -> None:
    parser = runs_parser(__doc__)
    parser.add_argument("--full", action="store_true", help="with margins and pictures")
    parser.add_argument("--json", type=Path, help="file for the figures")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    settings = RunSettings(
        candidates=options.candidates, seed=options.seed, quick=not options.full, budget_s=36000.0
    )
    if options.here:
        print(json.dumps(measured(options.tasks[0], settings)))
        return
    own = ["--candidates", str(options.candidates), "--seed", str(options.seed), "--here"]
    own += ["--full"] * options.full
    figures: dict[str, dict[str, float]] = {}
    rows = []
    for task in options.tasks:
        done = subprocess.run(
            [sys.executable, str(RUN), "statics_share", task, *own],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        figures[task] = one = json.loads(done.stdout.splitlines()[-1])
        share = (one["carrying"] + one["refuting"]) / one["run"]
        rows.append([task, *(f"{seconds:.3f}" for seconds in one.values()), f"{share:.1%}"])
        print("  ".join(rows[-1]), flush=True)
        if options.json:
            write_json(options.json, figures)
    print(format_table(["task", "run, CPU s", "start", *STEPS, "share"], rows))


if __name__ == "__main__":
    main()
