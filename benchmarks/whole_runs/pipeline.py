"""Batches as a whole: grasps a minute by stage with one and two workers, cost by size, tables and questions.

    ./run bench pipeline [--tasks N] [--candidates N] [--sizes N ...] [--rows N] [--like RUN]

Three parts, each after the other, so that they don't share cores:

- a batch of family members, with one worker and with two: grasps a minute that are certified, cleared and
  tested, what each stage takes, and how much faster two are. Everything is compiled before.
- one task with more and more candidates, verdicts alone: seconds and bytes a candidate, and the most memory
  that the process has taken.
- a table of many rows: seconds to write, to check every row, and to answer four questions; bytes a row.
"""

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from holdfast.base.files.json_file import read_json
from holdfast.pipeline.database import Collected, Row, checked_rows, query_table, write_table
from holdfast.pipeline.records import read_run

QUESTIONS = {
    "count": "SELECT count(*) FROM grasps WHERE good",
    "by object": "SELECT object, avg(held::INT), median(margin) FROM grasps GROUP BY object",
    "joints": "SELECT row, joints['index_pip'] AS q FROM grasps WHERE good ORDER BY q DESC LIMIT 10",
    "records": "SELECT max(length(record)) FROM grasps",
}


@dataclass(frozen=True)
class Cost:
    """What a command took: wall-clock time, CPU time of it and its processes, and the most memory of one.

    The memory is the most of any process that has ended so far.
    """

    wall_s: float
    cpu_s: float
    memory_MB: float


def command(*words: str) -> Cost:
    """Runs a command."""
    started, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, "-P", "-m", "holdfast", *words], capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 4):
        raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}: {done.stderr[-400:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(time.monotonic() - started, cpu_s, after.ru_maxrss / 1024.0)


def batches(folder: Path, tasks: int, candidates: int) -> dict[str, Any]:
    """A batch with one worker and with two."""
    names = [f"family:{family}:{seed}" for seed in range(tasks) for family in ("box", "cylinder", "handle")]
    common = ["--candidates", str(candidates), "--wanted", "0", "--budget", "900", "--quiet"]
    command("batch", "family:box:1000", *common, "--workers", "1", "--out", str(folder / "warm"))
    found: dict[str, Any] = {}
    for workers in (1, 2):
        out = folder / f"batch_{workers}"
        cost = command("batch", *names[:tasks], *common, "--workers", str(workers), "--out", str(out))
        outcomes = [read_json(path) for path in sorted((out / "outcomes").glob("*.json"))]
        runs = [run for outcome in outcomes for run in outcome["runs"]]
        stages = {
            stage: sum(run[stage] for run in runs) for stage in ("certified", "clear", "tested", "good")
        }
        seconds: dict[str, float] = {}
        for run in runs:
            for stage, spent in run["seconds"].items():
                seconds[stage] = seconds.get(stage, 0.0) + spent
        found[f"{workers} workers"] = {
            **asdict(cost),
            "grasps": stages,
            "grasps_a_minute": {stage: 60.0 * count / cost.wall_s for stage, count in stages.items()},
            "seconds_by_stage": seconds,
        }
        rates = ", ".join(f"{60.0 * count / cost.wall_s:.1f} {stage}" for stage, count in stages.items())
        spent = ", ".join(f"{stage} {part:.1f} s" for stage, part in seconds.items())
        took = f"{cost.wall_s:.1f} s, {cost.cpu_s:.1f} s of CPU"
        print(f"{tasks} tasks, {workers} workers: {took}; a minute: {rates}; {spent}", flush=True)
    found["times_faster"] = found["1 workers"]["wall_s"] / found["2 workers"]["wall_s"]
    print(f"two workers are {found['times_faster']:.2f} times as fast as one", flush=True)
    return found


def sizes(folder: Path, counts: list[int]) -> list[dict[str, Any]]:
    """One task with more and more candidates."""
    found = []
    for count in counts:
        out = folder / f"run_{count}"
        words = ["run", "family:box:0", "--candidates", str(count), "--wanted", "0", "--budget", "36000"]
        cost = command(*words, "--quick", "--quiet", "--workers", "1", "--out", str(out))
        record = read_run(out / "run.json")
        size = sum(path.stat().st_size for path in out.rglob("*") if path.is_file())
        stages = {stage: spent / count for stage, spent in record.seconds.items()}
        entry = {"candidates": len(record.grasps), **asdict(cost), "bytes": size}
        found.append({**entry, "seconds_a_candidate": stages})
        spent = ", ".join(f"{stage} {1e3 * part:.0f} ms" for stage, part in stages.items())
        print(
            f"{len(record.grasps)} candidates: {cost.wall_s:.1f} s, {cost.cpu_s:.1f} s of CPU; a candidate: "
            f"{1e3 * cost.cpu_s / count:.0f} ms of CPU ({spent}), {size / count / 1024:.0f} KiB; at most "
            f"{cost.memory_MB:.0f} MB of memory",
            flush=True,
        )
    return found


def many_runs(folder: Path, like: Path, rows: int) -> list[Path]:
    """Copies of a run's record, as many as it takes for so many grasps."""
    each = len(read_run(like / "run.json").grasps)
    runs = [folder / f"many_{k:07d}" for k in range(-(-rows // each))]
    for run in runs:
        run.mkdir(parents=True)
        shutil.copyfile(like / "run.json", run / "run.json")
    return runs


def tables(folder: Path, rows: int, like: Path | None) -> dict[str, Any]:
    """A table of many rows, whose grasps are those of a run."""
    if like is None:
        like = folder / "like"
        command("run", "upholding", "--candidates", "8", "--wanted", "0", "--quiet", "--out", str(like))
    table = folder / "t.parquet"
    collected = Collected(many_runs(folder / "many", like, rows), table)
    started, before = time.monotonic(), time.process_time()
    write_table(collected, table)
    rows = collected.rows
    written_s, written_cpu_s = time.monotonic() - started, time.process_time() - before
    started, before = time.monotonic(), time.process_time()
    whole = sum(isinstance(row, Row) for row in checked_rows(table))
    checked_s, checked_cpu_s = time.monotonic() - started, time.process_time() - before
    assert whole == rows
    print(
        f"{rows} rows: written in {written_s:.1f} s ({written_cpu_s:.1f} s of CPU), each checked in "
        f"{checked_s:.1f} s ({checked_cpu_s:.1f} s), {table.stat().st_size / rows / 1024:.2f} KiB a row",
        flush=True,
    )
    asked = {}
    for name, sql in QUESTIONS.items():
        started, before = time.monotonic(), time.process_time()
        query_table(table, sql)
        asked[name] = {"wall_s": time.monotonic() - started, "cpu_s": time.process_time() - before}
        print(f"  {name}: {asked[name]['wall_s']:.2f} s, {asked[name]['cpu_s']:.2f} s of CPU", flush=True)
    memory_MB = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"  at most {memory_MB:.0f} MB of memory", flush=True)
    return {
        "rows": rows,
        "written_s": written_s,
        "written_cpu_s": written_cpu_s,
        "checked_s": checked_s,
        "checked_cpu_s": checked_cpu_s,
        "bytes_a_row": table.stat().st_size / rows,
        "memory_MB": memory_MB,
        "asked": asked,
    }


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, default=12, help="tasks of the batch (12)")
    parser.add_argument("--candidates", type=int, default=8, help="of each (8)")
    parser.add_argument(
        "--sizes", type=int, nargs="*", default=[10, 100, 1000], help="candidates of one task"
    )
    parser.add_argument("--rows", type=int, default=10_000, help="of the table (10000)")
    parser.add_argument("--like", type=Path, metavar="RUN", help="whose grasps they are (one is made)")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    arguments = parser.parse_args()
    found: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        if arguments.rows:
            found["table"] = tables(folder, arguments.rows, arguments.like)
        if arguments.tasks:
            found["batch"] = batches(folder, arguments.tasks, arguments.candidates)
        if arguments.sizes:
            found["sizes"] = sizes(folder, arguments.sizes)
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
