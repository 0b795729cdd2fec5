"""Whether stored grasps get the same verdict with other numerical settings, and which do not, and why.

Usage: ./run bench verdicts [RUN ...] [--make FOLDER] [--seed N] [--candidates N] [--most N]
                            [--settings NAME ...] [--workers N] [--seconds S] [--json FILE]

Every grasp of the run folders that came to a test is put to it again as it is recorded, squeeze and all, with
its own settings and then with others: no no-slip passes, half and twice the time step, twice the step without
no-slip passes (`both`), another solver, gravity for its whole time, twice the no-slip passes. Cones stay
elliptic: inside a pyramid friction itself is another, by up to 30 % along its diagonals.

--make first makes runs of the nine tasks and of a member of each family, verdicts alone, where FOLDER has
none yet. With --json findings are kept grasp by grasp, and the same call goes on where one stopped.
"""

import argparse
from collections.abc import Iterable
from dataclasses import replace
from math import degrees
from pathlib import Path

from holdfast.base.text.console import format_table
from holdfast.mjcf import Grasp, HoldResult, HoldSettings, hold_test
from holdfast.mjcf.hold.hold import passes
from holdfast.mjcf.hold.trials.agreement import variants
from holdfast.objects.families import FAMILIES
from holdfast.pipeline.records import fingerprint, load_grasp_task, read_grasp, read_run
from holdfast.pipeline.run import RunSettings, run_task, to_grasp
from parts.hold_sample import Finding, Findings
from parts.neutral_scene import settings_of
from parts.nine_tasks import TASKS

CLASSES = ("held", "narrow", "failed")
NO_NOSLIP = "no no-slip passes"


def others(settings: HoldSettings) -> dict[str, HoldSettings]:
    """Other numerical settings of the same test, by name; what is asked of the grasp stays."""
    own = variants(settings)
    coarse = {"timestep_s": 2.0 * settings.timestep_s}
    found = own | {
        "twice the time step": replace(settings, **coarse),
        "gravity for the whole time": replace(settings, rest_s=None),
    }
    if settings.noslip_iterations:
        found["both"] = replace(own[NO_NOSLIP], **coarse)
        found["twice the no-slip passes"] = replace(
            settings, noslip_iterations=2 * settings.noslip_iterations
        )
    return found


def examine(path: Path, names: list[str] | None) -> list[Finding]:
    """The verdicts on one stored grasp; nothing where it came to no test or can't be repeated."""
    record = read_grasp(path)
    hold = record.hold
    if hold is None or not hold.directions:
        return []
    task = load_grasp_task(record, path)
    if record.task_fingerprint and record.task_fingerprint != fingerprint(task):
        return []
    settings = settings_of(hold.settings)
    grasp = to_grasp(record, task, settings, path)
    if grasp is None:
        return []
    again = hold_test(grasp, settings=settings, until_failed=True)
    wanted = others(settings)
    tried = {name: tested(grasp, wanted[name], again.held) for name in names or wanted}
    return [
        {
            "task": task.name,
            "hand": task.hand.name,
            "kind": hold.kind,
            "called": "failed" if not hold.held else "narrow" if record.is_narrow else "held",
            "repeated": again.held == hold.held,
            "here": words(again),
            "held": again.held,
            "margin": hold.margin,
            "others": tried,
        }
    ]


def tested(grasp: Grasp, settings: HoldSettings, held: bool) -> Finding:
    """The verdict with other settings and, where it is another one, what was seen."""
    if passes(grasp, settings=settings) == held:
        return {"held": held, "how": ""}
    result = hold_test(grasp, settings=settings, until_failed=True)
    return {"held": not held, "how": words(result)}


def words(result: HoldResult) -> str:
    """How a test ended, with what was measured up to there."""
    squeeze = f"squeeze {1e3 * result.squeeze_slip_m:.1f} mm {degrees(result.squeeze_rotation_rad):.1f} deg"
    if not result.directions:
        return f"moved by the squeeze, {squeeze}"
    last = result.directions[-1]
    worst = last if not last.held else max(result.directions, key=lambda entry: entry.slip_m)
    slip, turn = 1e3 * worst.slip_m, degrees(worst.rotation_rad)
    return f"{worst.outcome.value}, {slip:.1f} mm {turn:.1f} deg, {squeeze}"


def made(folder: Path, seed: int, candidates: int) -> list[Path]:
    """Run folders of the nine tasks and of a member of each family, made where they are missing."""
    names = [*TASKS, *(f"family:{family}:{seed}" for family in FAMILIES)]
    settings = RunSettings(candidates=candidates, seed=seed, wanted=0, budget_s=600.0, quick=True)
    found = []
    for name in names:
        run = folder / name.replace(":", "-")
        if not (run / "run.json").exists():
            run_task(name, run, settings)
        found.append(run)
    return found


def grasp_files(runs: Iterable[Path], most: int | None) -> dict[str, Path]:
    """Grasp files by run and name, the best of each run first."""
    found = {}
    for run in runs:
        for entry in read_run(run / "run.json").grasps[:most]:
            path = run / "grasps" / f"{entry.id}.json"
            if path.exists():
                found[f"{run.name}/{entry.id}"] = path
    return found


def share(findings: list[Finding], name: str | None = None) -> str:
    """How many of the findings a setting repeats; None: all settings."""
    if not findings:
        return "-"
    same = sum(
        all(other["held"] == f["held"] for key, other in f["others"].items() if name in (None, key))
        for f in findings
    )
    return f"{same} of {len(findings)}"


def print_agreement(findings: list[Finding]) -> None:
    """How many verdicts each setting repeats, by what the grasp is called and by the kind of its test."""
    names = [*dict.fromkeys(name for f in findings for name in f["others"])]
    kinds = [*dict.fromkeys(f["kind"] for f in findings)]
    rows = []
    for name in [*names, None]:
        own = [f for f in findings if name is None or name in f["others"]]
        by_class = [share([f for f in own if f["called"] == called], name) for called in CLASSES]
        by_kind = [share([f for f in own if f["kind"] == kind], name) for kind in kinds]
        same = int(share(own, name).split()[0]) if own else 0
        percent = f"{100.0 * same / max(len(own), 1):.1f} %"
        rows.append((name or "all of them", *by_class, *by_kind, share(own, name), percent))
    print(format_table(("settings", *CLASSES, *kinds, "all", "same"), rows))


def print_differences(findings: dict[str, list[Finding]]) -> None:
    """The grasps that another setting gives another verdict, and what was seen in both."""
    print("\nwhere verdicts differ:")
    for key, entries in findings.items():
        for f in entries:
            for name, other in f["others"].items():
                if other["held"] != f["held"]:
                    margin = "" if f["margin"] is None else f", margin {f['margin']:.2f}"
                    print(f"  {key} ({f['called']}{margin}): {f['here']}; with {name}: {other['how']}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="*", type=Path, metavar="RUN", help="run folders")
    parser.add_argument("--make", type=Path, metavar="FOLDER", help="make runs there")
    parser.add_argument("--seed", type=int, default=0, help="of the runs that are made")
    parser.add_argument("--candidates", type=int, default=16, help="in each run that is made")
    parser.add_argument("--most", type=int, help="grasps a run, the best first")
    parser.add_argument("--settings", nargs="+", metavar="NAME", help="these alone")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--seconds", type=float, default=3600.0, help="no grasp is begun after that")
    parser.add_argument("--json", type=Path, help="findings, to go on with")
    arguments = parser.parse_args()
    runs = list(arguments.runs)
    if arguments.make:
        runs += made(arguments.make, arguments.seed, arguments.candidates)
    if not runs:
        parser.error("name run folders, or --make FOLDER")
    known = others(HoldSettings())
    unknown = [name for name in arguments.settings or () if name not in known]
    if unknown:
        parser.error(f"--settings: unknown {', '.join(unknown)}; known: {'; '.join(known)}")
    plan = {key: (path, arguments.settings) for key, path in grasp_files(runs, arguments.most).items()}
    findings = Findings(arguments.json, {"settings": arguments.settings})
    whole = findings.collect(plan, examine, arguments.workers, arguments.seconds)
    everything = findings.of(plan)
    changed = sum(not f["repeated"] for f in everything)
    print(
        f"{len(everything)} grasps that came to a test; {len(everything) - changed} verdicts are as recorded"
    )
    if everything:
        print_agreement(everything)
        print_differences({key: findings.by_key.get(key, []) for key in plan})
    if not whole:
        print(f"\nstopped after {len(findings.by_key)} of {len(plan)} grasps; the same call goes on")


if __name__ == "__main__":
    main()
