"""How often a grasp that is called not holdable holds all the same, when the hand presses nevertheless.

Usage: ./run bench refusals [--seed N] [--each N] [--workers N] [--seconds S] [--json FILE]

Grasps of many kinds are planned for: of the nine tasks and of object families, by several hands, as the
solver finds them and strengthened, with the object's own friction and mass and with less friction or more
mass, without their last contact, with wider turns and stronger presses. Each that is called not holdable is
put to its test with unplanned squeezes. The others are tested with their plan, which says what share of all
that fail is named. With --json findings are kept as they come, and a call that ran out of --seconds can be
repeated to go on.
"""

import argparse
from collections import Counter
from dataclasses import dataclass, replace
from math import radians, sqrt
from pathlib import Path
from random import Random

from holdfast.base.text.console import format_table
from holdfast.mjcf import Grasp, HoldSettings, NotHoldable, plan_squeeze, preset_settings
from holdfast.mjcf.hold.hold import passes
from holdfast.mjcf.model.payload import payload
from holdfast.mjcf.squeeze.press_unplanned import press_along_normals
from holdfast.objects import LiftTest, PressTest, Task, TurnTest, load_task
from holdfast.retraction import find_approach
from holdfast.solver import Configuration, available_cores
from parts.hold_sample import Finding, Findings, as_found, found, strengthened

UNPLANNED_N = (3.0, 10.0, 30.0)
LIFTS = ("upholding", "handling", "incision", "lid_lifting", "service", "transportation", "holding")
FAMILIES = ("mug", "box", "plate", "bottle", "cylinder", "handle")
HANDS = ("shadow", "dlr2", "robonaut", "gifu2")


@dataclass(frozen=True)
class Change:
    """What is made harder.

    Attributes:
        friction: share of the object's friction.
        mass: multiple of the object's mass, in lifts.
        without: how many of the last contacts are left out.
        angle_deg: of a turn; 0 for the task's own.
        load: multiple of a hinge's friction or of a press's force.
    """

    friction: float = 1.0
    mass: float = 1.0
    without: int = 0
    angle_deg: float = 0.0
    load: float = 1.0

    def task(self, task: Task) -> Task:
        """The task with what belongs to it changed."""
        contacts = task.contacts[: len(task.contacts) - self.without]
        test = task.test
        if isinstance(test, TurnTest):
            angle = radians(self.angle_deg) if self.angle_deg else test.angle_rad
            test = replace(test, angle_rad=angle, friction_torque_Nm=self.load * test.friction_torque_Nm)
        if isinstance(test, PressTest):
            kept = tuple(k for k in test.contacts if k < len(contacts))
            test = replace(test, force_N=self.load * test.force_N, contacts=kept)
        return replace(task, contacts=contacts, test=test)

    def settings(self, task: Task) -> HoldSettings:
        """The settings of a test of it."""
        settings = preset_settings("holdfast", task)
        settings = replace(settings, friction=self.friction * settings.sliding_friction(task.object))
        if isinstance(task.test, LiftTest) and self.mass != 1.0:
            return replace(settings, object_mass_kg=self.mass * payload(task, settings).inertia.mass)
        return settings

    def __str__(self) -> str:
        words = [
            ("friction x", self.friction, 1.0),
            ("mass x", self.mass, 1.0),
            ("contacts -", self.without, 0),
        ]
        words += [("turn by deg ", self.angle_deg, 0.0), ("load x", self.load, 1.0)]
        return ", ".join(f"{word}{value:g}" for word, value, usual in words if value != usual) or "as it is"


CHANGES = (Change(), Change(0.5), Change(0.25), Change(mass=10.0), Change(mass=40.0), Change(0.5, 10.0))
FEWER = (Change(without=1), Change(without=1, mass=10.0))
TURNS = (Change(angle_deg=30.0), Change(angle_deg=60.0), Change(0.3), Change(load=5.0), Change(load=40.0))
PRESSES = (Change(load=3.0), Change(load=10.0), Change(0.25), Change(load=40.0))


def jobs(seed: int, each: int) -> dict[str, tuple[str, Change, bool, int, int]]:
    """Task, change, whether grasps are strengthened, how many, and seed, by a key."""
    sources = [(name, CHANGES) for name in LIFTS]
    sources += [(f"family:{name}:{seed}", CHANGES) for name in FAMILIES]
    for k, hand in enumerate(HANDS):
        sources += [(f"{name}@{hand}", CHANGES) for name in ("upholding", f"family:{FAMILIES[k]}:{seed + 1}")]
    sources += [(name, FEWER) for name in ("handling", "incision", "service", "transportation", "holding")]
    sources += [("tuning", TURNS), ("paper/tuning", TURNS), ("playing", PRESSES)]
    plain = {(name, change, False) for name, changes in sources for change in changes}
    strong = {(name, change, True) for name in LIFTS for change in (Change(mass=10.0), Change(mass=40.0))}
    ordered = sorted(plain | strong, key=lambda job: (str(job[1]), job[0], job[2]))
    # Every job has configurations of its own, so that no two findings are about the same.
    plan = [
        (
            f"{name}, {change}{', strengthened' if strong else ''}",
            (name, change, strong, each, 1000 * seed + k),
        )
        for k, (name, change, strong) in enumerate(ordered)
    ]
    # In mixed order, so that one that is stopped has something of each.
    Random(seed).shuffle(plan)
    return dict(plan)


def examine(name: str, change: Change, strong: bool, each: int, seed: int) -> list[Finding]:
    """What is said of some grasps, and what they do."""
    task = change.task(load_task(name))
    settings = change.settings(task)
    findings = []
    for configuration in found(task, each, seed):
        # Strengthened for the object as it is: what makes it harder comes as a surprise.
        usual = preset_settings("holdfast", task)
        clear = strengthened(configuration, usual) if strong else as_found(configuration)
        if clear is not None:
            findings.append({"task": name, "change": str(change), "strong": strong, **judge(clear, settings)})
    return findings


def judge(configuration: Configuration, settings: HoldSettings) -> Finding:
    """Whether a grasp is named, and whether it passes with its plan or, named, with any unplanned squeeze."""
    squeeze = plan_squeeze(configuration, settings=settings)
    approach = find_approach(configuration)
    if not isinstance(squeeze, NotHoldable):
        return {
            "obstacle": None,
            "passed": passes(Grasp(configuration, squeeze, approach), settings=settings),
        }
    grasps = (
        Grasp(configuration, press_along_normals(configuration, force, settings=settings), approach)
        for force in UNPLANNED_N
    )
    passed = any(passes(grasp, settings=settings) for grasp in grasps)
    return {"obstacle": squeeze.obstacle.name, "share": squeeze.load_factor, "passed": passed}


def print_findings(findings: list[Finding]) -> None:
    """Counts by kind, and a bound on the rate of contradictions."""
    named = [f for f in findings if f["obstacle"] is not None]
    for kind in ("obstacle", "change", "task"):
        print_counts(kind, findings if kind != "obstacle" else named)
    contradicted = [f for f in named if f["passed"]]
    failed = [f for f in findings if not f["passed"]]
    known = len(named) - len(contradicted)
    print(f"\n{len(findings)} grasps; {len(failed)} failed, {known} of them named beforehand")
    print(f"named not holdable: {len(named)}; of these held all the same: {len(contradicted)}")
    if named:
        print(f"95 % bound on that rate: {100.0 * upper_bound(len(contradicted), len(named)):.1f} %")
    for finding in contradicted:
        print(f"  {finding}")


def print_counts(kind: str, findings: list[Finding]) -> None:
    """A table of one kind of label."""
    tried = Counter(f[kind] for f in findings)
    named = Counter(f[kind] for f in findings if f["obstacle"] is not None)
    wrong = Counter(f[kind] for f in findings if f["obstacle"] is not None and f["passed"])
    failed = Counter(f[kind] for f in findings if not f["passed"])
    rows = [tuple(str(x) for x in (k, tried[k], failed[k], named[k], wrong[k])) for k in sorted(tried)]
    print(format_table((kind, "tried", "failed", "named", "contradicted"), rows), end="\n\n")


def upper_bound(count: int, of: int) -> float:
    """Upper end of Wilson's interval at 95 %, two-sided."""
    z, p = 1.96, count / of
    middle = p + z * z / (2.0 * of)
    return (middle + z * sqrt(p * (1.0 - p) / of + z * z / (4.0 * of * of))) / (1.0 + z * z / of)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--each", type=int, default=2, help="configurations of each kind")
    parser.add_argument("--workers", type=int, default=available_cores())
    parser.add_argument("--seconds", type=float, default=3600.0, help="no work is begun after that")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    plan = jobs(arguments.seed, arguments.each)
    findings = Findings(arguments.json, {"seed": arguments.seed, "each": arguments.each})
    whole = findings.collect(plan, examine, arguments.workers, arguments.seconds)
    print_findings(findings.of(plan))
    if not whole:
        print(f"stopped after {len(findings.by_key)} of {len(plan)} kinds; the same call goes on")


if __name__ == "__main__":
    main()
