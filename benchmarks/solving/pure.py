"""Branch and prune alone: boxes, linear programs and seconds to the first solution of the paper's tasks.

    ./run bench pure FILE [--json OUT] [--budget SECONDS]

FILE holds the published numbers (see `parts/paper_tasks.py`). Two moments are timed, in seconds of the
process on one core after a first solve that loads the compiled code: when a solution is first proved to lie
in some box of the tree, and when a box no wider than sigma = 0.1 in any input (lengths in units of 50 mm,
cosines, sines and patch parameters in units of 1) holds a certified one. The authors report the second,
without a proof.
"""

import argparse
import time
from contextlib import closing
from pathlib import Path
from typing import Any

from holdfast.base.files.output_file import write_json
from holdfast.objects import Task
from holdfast.solver import SolveResult, Verdict, iterate
from parts.paper_tasks import load_paper_tasks

SIGMA = 0.1
# Boxes that the authors' program processed on 31 to 64 cores, and how long that took.
AUTHORS = {
    "tuning": (1286, 68), "upholding": (2003, 106), "handling": (3211, None), "incision": (3606, None),
    "lid lifting": (1454, 114), "service": (1739, None), "transportation": (1329, 375),
}  # fmt: skip


def measure(task: Task, budget_s: float) -> dict[str, Any]:
    """Searches one task until a small certified box or the end of the budget."""
    started = time.process_time()
    witness: dict[str, Any] | None = None
    with closing(iterate(task, sigma=SIGMA, pure=True)) as steps:
        for search in steps:
            seconds = time.process_time() - started
            result = SolveResult.of(search, 1)
            known = any(box.witness is not None for *_, box in search.state.frontier)
            if witness is None and (known or result.verdict is Verdict.SOLVED):
                witness = {"boxes": result.boxes, "lps": result.lps, "seconds": round(seconds, 3)}
            if result.verdict is Verdict.SOLVED or seconds > budget_s:
                break
    return {
        "verdict": result.verdict.value, "boxes": result.boxes, "lps": result.lps,
        "seconds": round(seconds, 3), "proved": witness,
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", help="the published numbers")
    parser.add_argument("--json", type=Path, help="file for the figures")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds of the process for each task")
    options = parser.parse_args()
    tasks = load_paper_tasks(options.file)
    measure(next(iter(tasks.values())), 10.0)
    figures = {}
    for name, task in tasks.items():
        figures[name] = row = measure(task, options.budget) | {"authors_boxes": AUTHORS[name][0]}
        proved = row["proved"]
        first = f"box {proved['boxes']}, {proved['seconds']:.2f} s" if proved else "none"
        print(
            f"{name:15} {row['verdict']:9} {row['boxes']:5} boxes (the authors: {AUTHORS[name][0]}), "
            f"{row['lps']:5} LPs, {row['seconds']:6.2f} s; first proof: {first}",
            flush=True,
        )
    if options.json:
        write_json(options.json, figures)


if __name__ == "__main__":
    main()
