"""The solver against its goals and its peers: published systems, codac, SCIP, first solutions, candidates.

    ./run bench solver [--cap SECONDS] [--json FILE] [--limits FILE] [--systems NAME ...]

Without --systems the benchmarks `pure`, `twins` and `workers` follow; their figures go into the same file.
Everything is measured in one run, one thread each, in CPU time, and short runs are the median of three. Peers
run in processes of their own under the same cap: codac (HC4, interval Newton, bisection;
`peers/peer_codac.py`) on systems with a known count, SCIP on those without solutions, where it proves
nothing, for it works with tolerances. A ratio is a peer's time by ours where both finish with the right
answer.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import paper_times
import systems
from holdfast.base.files.output_file import write_json
from holdfast.solver import Verdict, solve
from parts.paper_tasks import load_paper_tasks
from parts.places import PEERS, PEERS_PYTHON, RUN, SHARED

SHORT_S = 1.0


def measure_ours(entry: dict, cap_s: float) -> dict:
    rows = [systems.measure(entry, cap_s)]
    if rows[0]["seconds"] < SHORT_S:
        rows += [systems.measure(entry, cap_s) for _ in range(2)]
    return sorted(rows, key=lambda row: row["seconds"])[len(rows) // 2]


def measure_peer(name: str, entry: dict, cap_s: float) -> dict:
    """What the peer says; codac gets a second try without its centred form, which may lose roots."""
    out = run_peer(name, entry, cap_s, centred=True)
    if name == "codac" and not out["right"]:
        other = run_peer(name, entry, cap_s, centred=False)
        return other if other["right"] else out
    return out


def run_peer(name: str, entry: dict, cap_s: float, centred: bool) -> dict:
    """One run; a peer that breaks or overruns its cap has not finished."""
    task = {key: entry[key] for key in ("variables", "equations")} | {"cap": cap_s, "centred": centred}
    command = [str(PEERS_PYTHON), str(PEERS / f"peer_{name}.py")]
    unfinished = {"finished": False, "right": False, "seconds": cap_s}
    try:
        done = subprocess.run(
            command, input=json.dumps(task), capture_output=True, text=True, timeout=6.0 * cap_s + 30.0
        )
    except subprocess.TimeoutExpired:
        return unfinished
    if done.returncode:
        return unfinished | {"error": done.stderr.strip()[-200:]}
    out = json.loads(done.stdout)
    if name == "scip":
        right = out["infeasible"] and entry["n_real_solutions"] == 0
    else:
        right = out["solutions"] == entry["n_real_solutions"] and out["unproved"] == 0
    return out | {"right": out["finished"] and right}


def peers_of(entry: dict) -> list[str]:
    if entry["n_real_solutions"] is None or not PEERS_PYTHON.is_file():
        return []
    return ["codac"] if entry["n_real_solutions"] else ["codac", "scip"]


def compare_systems(entries: list[dict], cap_s: float) -> list[dict]:
    rows = []
    for entry in entries:
        row = measure_ours(entry, cap_s)
        row["peers"] = {name: measure_peer(name, entry, cap_s) for name in peers_of(entry)}
        rows.append(row)
        said = [f"{'ok' if row['right'] else '--'} {row['name']:22} {row['seconds']:7.3f} s"]
        for name, peer in row["peers"].items():
            said.append(f"{name} {'ok' if peer['right'] else '--'} {peer['seconds']:7.3f} s")
        print("  ".join(said), flush=True)
    return rows


def summarise(rows: list[dict], peer: str) -> dict:
    """Geometric mean of the peer's time by ours where both are right."""
    met = [row for row in rows if peer in row["peers"]]
    both = [row for row in met if row["right"] and row["peers"][peer]["right"]]
    ratios = [row["peers"][peer]["seconds"] / max(row["seconds"], 1e-6) for row in both]
    return {
        "peer": peer,
        "asked": len(met),
        "peer_right": sum(row["peers"][peer]["right"] for row in met),
        "ours_right": sum(row["right"] for row in met),
        "both": len(both),
        "geometric_mean_ratio": float(np.exp(np.mean(np.log(ratios)))) if ratios else None,
    }


def measure_tasks(path: Path) -> list[dict]:
    tasks = load_paper_tasks(str(path))
    solve(next(iter(tasks.values())), candidates=2)  # compiles what is not compiled yet
    rows = []
    for name, task in tasks.items():
        runs = [paper_times.timed(task, 1, seed) for seed in paper_times.SEEDS]
        times = [seconds for _, seconds in runs]
        row = {
            "task": name,
            "first_s": float(np.median(times)),
            "worst_first_s": max(times),
            "solved": sum(result.verdict is Verdict.SOLVED for result, _ in runs),
            "asked": len(runs),
        }
        if len(task.contacts) == 2:
            result, seconds = paper_times.timed(task, paper_times.CANDIDATES, 0)
            row["candidates_per_s"] = len(result.configurations) / seconds
        rows.append(row)
        print(
            f"{name:22} first {row['first_s']:.3f} s, worst {row['worst_first_s']:.3f} s, "
            f"solved {row['solved']} of {row['asked']}"
            + (f", {row['candidates_per_s']:.0f} candidates a second" if "candidates_per_s" in row else ""),
            flush=True,
        )
    return rows


def run_part(name: str, *words: str) -> object:
    """The figures of another benchmark of the solver, run in a process of its own; None where it broke."""
    print(f"\n{name}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figures.json"
        command = [sys.executable, str(RUN), name, *words, "--json", str(path)]
        done = subprocess.run(command, check=False)
        return json.loads(path.read_text("utf-8")) if done.returncode == 0 else None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cap", type=float, default=10.0, metavar="SECONDS")
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--limits", metavar="FILE", help="of `twins`: limits of feasibility that are known")
    parser.add_argument("--systems", nargs="+", metavar="NAME", help="only these systems, and no tasks")
    arguments = parser.parse_args()
    path = SHARED / "systems" / "systems.json"
    if not path.is_file():
        print(f"solver: {path} is missing; set HOLDFAST_SHARED", file=sys.stderr)
        return 2
    if not PEERS_PYTHON.is_file():
        print("codac and SCIP are not installed: no comparison")
    entries = json.loads(path.read_text("utf-8"))["systems"]
    systems.measure(entries[0], 60.0)  # compiles what is not compiled yet
    chosen = [e for e in entries if not arguments.systems or e["name"] in arguments.systems]
    rows = compare_systems(chosen, arguments.cap)
    print(f"{sum(row['right'] for row in rows)} of {len(rows)} right, {sum(r['lost'] for r in rows)} lost")
    summaries = [summarise(rows, peer) for peer in ("codac", "scip")]
    for summary in summaries:
        if summary["both"]:
            print(
                f"{summary['peer']}: right on {summary['peer_right']} of {summary['asked']} (we on "
                f"{summary['ours_right']}); {summary['geometric_mean_ratio']:.1f} times our time, "
                f"geometric mean of the {summary['both']} that both finish"
            )
    out = {"cap_s": arguments.cap, "systems": rows, "peers": summaries}
    if not arguments.systems:
        published = SHARED / "facts" / "paper_tasks.json"
        out["tasks"] = measure_tasks(published)
        out["pure"] = run_part("pure", str(published))
        known = ["--limits", str(Path(arguments.limits).resolve())] if arguments.limits else []
        out["twins"] = run_part("twins", str(published), *known)
        out["workers"] = run_part("workers")
    if arguments.json:
        write_json(Path(arguments.json), out)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
