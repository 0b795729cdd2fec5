"""Isolates all solutions of the shared polynomial systems: verdicts, boxes and seconds a system.

Seconds, and the cap, are CPU time of this process, which is single-threaded; the wall's are in the JSON file.

    ./run bench systems [--cap SECONDS] [--json FILE] [NAME ...]

The systems are read from systems.json in $HOLDFAST_SHARED/systems (beside the repository: ../shared/systems).
A system counts as right when its verdict and number of solutions are the published ones and every published
solution lies in a box of the result; as lost when one lies in none.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from holdfast.solver import SystemResult, Verdict, solve_system
from holdfast.solver.systems.file import SystemProblem, system_from_data
from parts.places import SHARED

# Published solutions are rounded; a box of 1e-15 can't hold them as printed.
ROUNDING = 1e-6


def lost_solutions(points: list[list[float]], result: SystemResult) -> int:
    boxes = [(s.lower, s.upper) for s in result.solutions] + list(result.remaining)
    lost = 0
    for point in np.array(points):
        room = ROUNDING * (1.0 + np.abs(point))
        lost += not any(np.all(point >= lo - room) and np.all(point <= hi + room) for lo, hi in boxes)
    return lost


def is_right(entry: dict, problem: SystemProblem, result: SystemResult) -> bool:
    count = entry["n_real_solutions"]
    if count is None:  # a set of solutions: covered, and not called empty or finite
        if result.covers:
            return result.verdict is Verdict.COMPLETE
        return result.verdict is Verdict.UNDECIDED
    expected = Verdict.COMPLETE if count else Verdict.INFEASIBLE
    return result.verdict is expected and len(result.solutions) == count


def solved(problem: SystemProblem, cap_s: float) -> tuple[SystemResult, float]:
    """What becomes of a system within so many seconds of the processor, and how many it takes."""
    started = time.process_time()
    result = solve_system(
        problem.equations,
        problem.lower,
        problem.upper,
        budget_s=np.inf,
        should_stop=lambda: time.process_time() - started > cap_s,
    )
    return result, time.process_time() - started


def measure(entry: dict, cap_s: float) -> dict:
    problem = system_from_data({key: entry[key] for key in ("variables", "equations")}, entry["name"])
    result, seconds = solved(problem, cap_s)
    lost = lost_solutions(entry.get("solutions") or entry.get("sample_points") or [], result)
    return {
        "name": entry["name"],
        "verdict": result.verdict.value,
        "solutions": len(result.solutions),
        "expected": entry["n_real_solutions"],
        "undecided": len(result.remaining),
        "lost": lost,
        "right": is_right(entry, problem, result) and lost == 0,
        "boxes": result.boxes,
        "seconds": seconds,
        "wall_seconds": result.seconds,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--cap", type=float, default=10.0, metavar="SECONDS")
    parser.add_argument("--json", metavar="FILE")
    arguments = parser.parse_args()
    path = SHARED / "systems" / "systems.json"
    if not path.is_file():
        print(f"systems: {path} is missing; set HOLDFAST_SHARED", file=sys.stderr)
        return 2
    entries = json.loads(path.read_text("utf-8"))["systems"]
    chosen = [e for e in entries if not arguments.names or e["name"] in arguments.names]
    measure(entries[0], 60.0)  # compiles what is not compiled yet
    rows = []
    for entry in chosen:
        row = measure(entry, arguments.cap)
        rows.append(row)
        mark = "ok" if row["right"] else "--"
        print(
            f"{mark} {row['name']:22} {row['verdict']:10} {row['solutions']:6} of {row['expected']!s:4} "
            f"undecided {row['undecided']:5} lost {row['lost']} boxes {row['boxes']:7} "
            f"{row['seconds']:6.2f} s",
            flush=True,
        )
    right = sum(row["right"] for row in rows)
    print(f"{right} of {len(rows)} right, {sum(row['lost'] for row in rows)} solutions lost")
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(rows, indent=1), "utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
