"""Runs the nine tasks of the paper from end to end, and writes the README's table from what they left.

    ./run bench tasks [--runs DIR] [--keep] [--candidates N] [--readme] [TASK ...]

Each task is a `holdfast run` of its own, into DIR/<task> (runs). With --keep a complete run that is there
already counts. --readme puts the figures into docs/results.json and the table of them into README.md; without
it the table is printed alone.
"""

import argparse
import json
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

import holdfast
from holdfast.base.files.json_file import read_json
from holdfast.base.files.output_file import write_json, write_text
from holdfast.base.text.console import format_table
from holdfast.objects import LiftTest, PressTest, TurnTest, load_task
from holdfast.pipeline.records import read_run
from parts.nine_tasks import TASKS
from parts.places import ROOT

RESULTS, README = ROOT / "docs" / "results.json", ROOT / "README.md"
BEGIN, END = "<!-- results: written by ./run bench tasks --readme -->", "<!-- end of results -->"
KINDS = {LiftTest: "lift", TurnTest: "turn", PressTest: "press"}
BUDGET_S = "240"


@dataclass(frozen=True)
class Result:
    """What became of a task.

    Attributes:
        task: its name.
        verdict: of the run.
        test: kind of the physical test.
        contacts: number of contacts.
        grasps: configurations that the solver gave.
        certified: of these, how many are proved after all stages.
        clear: of the certified, how many are free of penetration.
        held: of the clear, how many passed the physical test.
        narrow: of these, how many are held narrowly.
        different: of the held, how many are like no other.
        solver_s: wall-clock seconds of the solver.
        whole_s: wall-clock seconds of the whole run.
    """

    task: str
    verdict: str
    test: str
    contacts: int
    grasps: int
    certified: int
    clear: int
    held: int
    narrow: int
    different: int
    solver_s: float
    whole_s: float


def run(task: str, folder: Path, candidates: int) -> None:
    """Runs a task into a folder; its exit code says less than what it leaves."""
    command = [sys.executable, "-P", "-m", "holdfast", "run", task, "--out", str(folder)]
    subprocess.run([*command, "--candidates", str(candidates), "--budget", BUDGET_S], check=False)


def is_complete(folder: Path) -> bool:
    """Whether a folder holds a run that has ended."""
    record = folder / "run.json"
    return record.exists() and bool(read_json(record)["complete"])


def result(task: str, folder: Path) -> Result:
    """The figures of a run."""
    record = read_run(folder / "run.json")
    grasps = record.grasps
    certified = [grasp for grasp in grasps if grasp.certified]
    return Result(
        task,
        record.verdict,
        KINDS[type(load_task(task).test)],
        len(grasps[0].contacts) if grasps else 0,
        len(grasps),
        len(certified),
        sum(grasp.is_clear for grasp in certified),
        len(record.good),
        len(record.good) - len(record.firm),
        len(record.different),
        round(record.seconds.get("solve", 0.0), 3),
        round(sum(record.seconds.values()), 1),
    )


def table(results: list[Result]) -> str:
    """The figures in Markdown."""
    head = [
        "| task | contacts | certified | clear | passed | narrowly | different | test | solver | whole run |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    rows = [
        f"| {r.task} | {r.contacts} | {r.certified} of {r.grasps} | {r.clear} | {r.held} | {r.narrow} "
        f"| {r.different} | {r.test} | {r.solver_s:.1f} s | {r.whole_s:.0f} s |"
        for r in results
    ]
    return "\n".join([*head, *rows])


def readme_with(text: str, results: list[Result]) -> str:
    """The README with its table made anew."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{table(results)}\n{END}{after}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("tasks", nargs="*", metavar="TASK", default=list(TASKS))
    parser.add_argument("--runs", type=Path, default=Path("runs"))
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--candidates", type=int, default=16)
    parser.add_argument("--readme", action="store_true")
    arguments = parser.parse_args()
    results = []
    for task in arguments.tasks:
        folder = arguments.runs / task.replace("/", "_")
        if not (arguments.keep and is_complete(folder)):
            run(task, folder, arguments.candidates)
        results.append(result(task, folder))
    rows = [tuple(str(value) for value in asdict(r).values()) for r in results]
    print(format_table(tuple(asdict(results[0])), rows))
    if arguments.readme:
        # The table and its source are changed together, or a test says so.
        write_json(RESULTS, {"holdfast": holdfast.__version__, "tasks": [asdict(r) for r in results]})
        write_text(README, readme_with(README.read_text("utf-8"), results))


def results_on_file() -> list[Result]:
    """The figures that the README shows."""
    return [Result(**entry) for entry in json.loads(RESULTS.read_text("utf-8"))["tasks"]]


if __name__ == "__main__":
    main()
