"""How many candidates hold, how that goes with their plan, and what a grasp that holds costs.

Usage: ./run bench candidates [--seed N] [--count N] [--ways 1 4] [--workers N] [--seconds S]
                              [--json FILE] [TASK ...]

Without names of tasks it is the nine built-in ones and thirty members of families. Each task is solved
with the seed, and --count of its configurations are made grasps and tried, as `run` does it: those that
are found first (way 1), or chosen among so many times as many (way 4). For each task and way: how many
hold; of those whose plan carries the load that is planned for; the largest plan; and CPU seconds, of
solver, making and trying, by grasp that holds. Tasks whose plans do not carry their load are named with
what would do. With --json findings are kept as they come, and a call that ran out of --seconds can be
repeated to go on.
"""

import argparse
import itertools
import time
from dataclasses import dataclass
from pathlib import Path

from holdfast.base.text.console import format_table
from holdfast.grasping import Refusal, make_grasp, solve_for_starts, try_hold
from holdfast.mjcf import HoldSettings, preset_settings
from holdfast.objects import TurnTest, load_task
from holdfast.objects.families import FAMILIES
from holdfast.solver import Configuration, available_cores
from parts.hold_sample import Finding, Findings
from parts.nine_tasks import TASKS

# Of each family so many members, the first ones from a number on that weigh neither too little nor too much.
MEMBERS, FIRST_MEMBER, MASSES_KG = 5, 40, (0.05, 0.8)
# The share that should hold of the candidates of a task whose plan carries the load.
AIM = 0.8
BUDGET_S = 120.0
# A turn is planned for 1.1 times the friction of its hinge, whatever the settings say.
TURN_LOAD = 1.1
ENOUGH = 1.0 - 1e-4


def examine(name: str, way: int, count: int, seed: int) -> list[Finding]:
    """What becomes of the candidates of a task; the first has the CPU seconds of the solver."""
    task = load_task(name)
    settings = preset_settings("holdfast", task)
    wanted = TURN_LOAD if isinstance(task.test, TurnTest) else settings.planned_load
    warm_up(name, settings, seed)
    begun = time.process_time()
    starts = solve_for_starts(task, count=count, choice=way, settings=settings, seed=seed, budget_s=BUDGET_S)
    solve_s = time.process_time() - begun
    findings: list[Finding] = [
        {"task": name, "way": way, "wanted": wanted, **judge(configuration, settings)}
        for configuration in starts.configurations[:count]
    ]
    for finding in findings[:1]:
        finding |= {"solve_s": solve_s, "solved": len(starts.result)}
    return findings


def family_tasks() -> list[str]:
    """Members of all families, as tasks."""
    names: list[str] = []
    for family in FAMILIES:
        members = (f"family:{family}:{number}" for number in itertools.count(FIRST_MEMBER))
        fits = (name for name in members if _has_mass(name))
        names += itertools.islice(fits, MEMBERS)
    return names


def _has_mass(name: str) -> bool:
    lightest, heaviest = MASSES_KG
    return lightest <= load_task(name).object.inertia.mass <= heaviest


def warm_up(name: str, settings: HoldSettings, seed: int) -> None:
    """Whatever is compiled or read once in a process, so that it is not counted."""
    task = load_task(name)
    for configuration in solve_for_starts(
        task, count=1, choice=2, settings=settings, seed=seed + 500, budget_s=BUDGET_S
    ).configurations[:1]:
        judge(configuration, settings)


def judge(configuration: Configuration, settings: HoldSettings) -> Finding:
    """Plan, verdict and CPU seconds of a candidate."""
    begun = time.process_time()
    made = make_grasp(configuration, settings=settings)
    made_s = time.process_time() - begun
    if isinstance(made, Refusal):
        limit = made.limit
        load = 0.0 if limit is None else limit.load_factor
        found = {"held": False, "narrow": False, "load": load, "clear": limit is not None}
        return found | {"why": str(made), "made_s": made_s, "tried_s": 0.0, "limit": str(limit or "")}
    trial = try_hold(made, settings=settings, fingers=True)
    tried_s = time.process_time() - begun - made_s
    lost = sorted({entry.outcome.value for entry in trial.result.directions if not entry.held})
    return {
        "held": trial.held,
        "narrow": trial.is_narrow,
        "load": made.squeeze.load_factor,
        "clear": True,
        "why": "; ".join(lost),
        "made_s": made_s,
        "tried_s": tried_s,
        "limit": "" if trial.held else str(trial.limit or ""),
    }


@dataclass(frozen=True)
class Row:
    """The candidates of a task in one way."""

    task: str
    way: int
    findings: list[Finding]

    @property
    def carrying(self) -> list[Finding]:
        """Those whose plan carries what is planned for."""
        return [f for f in self.findings if f["load"] >= f["wanted"] * ENOUGH]

    @property
    def reaches_aim(self) -> bool:
        """Whether as many of those hold as should; also where there is none."""
        return sum(f["held"] for f in self.carrying) >= AIM * len(self.carrying)

    @property
    def cpu_s(self) -> float:
        """CPU seconds of all stages."""
        return sum(f["made_s"] + f["tried_s"] + f.get("solve_s", 0.0) for f in self.findings)

    def cells(self) -> tuple[str, ...]:
        """The row of the table."""
        held = sum(f["held"] for f in self.findings)
        return (
            self.task,
            str(self.way),
            str(sum(f.get("solved", 0) for f in self.findings)),
            f"{held} of {len(self.findings)}",
            str(sum(f["narrow"] for f in self.findings)),
            f"{sum(f['held'] for f in self.carrying)} of {len(self.carrying)}",
            f"{max((f['load'] for f in self.findings), default=0.0):.2f}",
            f"{self.cpu_s:.1f}",
            f"{self.cpu_s / held:.2f}" if held else "-",
        )


def print_rows(rows: list[Row]) -> None:
    """The table, the shares that hold, and what tasks lack whose plans don't carry their load."""
    header = ("task", "way", "solved", "held", "narrowly", "plan carries: held", "largest", "CPU/s", "each/s")
    print(format_table(header, [row.cells() for row in rows]))
    for way in sorted({row.way for row in rows}):
        mine = [row for row in rows if row.way == way]
        carrying = [f for row in mine for f in row.carrying]
        held = sum(f["held"] for f in carrying)
        reached = sum(row.reaches_aim for row in mine if row.carrying)
        planned = sum(bool(row.carrying) for row in mine)
        print(
            f"way {way}: where the plan carries the load {held} of {len(carrying)} hold, "
            f"{AIM:.0%} or more in {reached} of {planned} tasks with such plans"
        )
        for row in mine:
            limits = [f for f in row.findings if f["limit"]]
            if not row.carrying and limits:
                print(f"  {row.task}: {max(limits, key=lambda f: float(f['load']))['limit']}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", metavar="TASK")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=16, help="candidates of each task")
    parser.add_argument("--ways", type=int, nargs="+", default=[1, 4])
    parser.add_argument("--workers", type=int, default=available_cores())
    parser.add_argument("--seconds", type=float, default=3600.0, help="no work is begun after that")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    tasks = arguments.tasks or [*TASKS, *family_tasks()]
    jobs = {
        f"{name}, way {way}": (name, way, arguments.count, arguments.seed)
        for name in tasks
        for way in arguments.ways
    }
    findings = Findings(arguments.json, {"seed": arguments.seed, "count": arguments.count})
    whole = findings.collect(jobs, examine, arguments.workers, arguments.seconds)
    rows = [Row(job[0], job[1], findings.of([key])) for key, job in jobs.items() if key in findings.by_key]
    print_rows(rows)
    if not whole:
        print(f"stopped after {len(rows)} of {len(jobs)} tasks and ways; the same call goes on")


if __name__ == "__main__":
    main()
