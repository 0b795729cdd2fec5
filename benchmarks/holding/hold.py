"""How many grasps pass their task's test, whether other settings agree, and how fast many are tested.

Usage: ./run bench hold [speed | verdicts] [--tasks TASK ...] [--count N] [--plain N] [--presets N] [--seed N]
               [--workers N] [--seconds S] [--json FILE]

`verdicts` solves each task (the nine unless some are named), strengthens and retracts as a run does, and
prints the share of certified and clear grasps that pass; the verdicts at half the time step, with another
solver and twice the no-slip passes; how well the analytic measures and the planned load predict the outcome
(AUC), over all grasps and within tasks; and where the verdicts of the presets differ. --plain adds grasps as
the solver finds them, most of which fail: verdicts about them must agree, too. With --json findings are kept
grasp by grasp, and a call that ran out of --seconds can be repeated to go on.
`speed` counts physics steps in the test of many grasps against plain mj_step with the same model on as many
threads, in steps per second of processor time, which other processes don't disturb, and in wall-clock time.
"""

import argparse
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
from holdfast.base.text.console import format_table
from holdfast.mjcf import (
    Grasp,
    HoldResult,
    HoldSettings,
    NotHoldable,
    auc,
    grasp_quality,
    hold_test,
    plan_squeeze,
    preset_names,
    preset_settings,
    settings_agreement,
)
from holdfast.mjcf.hold.hold import passes
from holdfast.mjcf.hold.lift import Lift
from holdfast.objects import LiftTest, load_task
from holdfast.retraction import Approach, find_approach
from holdfast.solver import Configuration, available_cores
from parts.hold_sample import Finding, Findings, as_found, found, strengthened
from parts.nine_tasks import TASKS

ROUNDS = 3
MODES = ("speed", "verdicts")
OWN = "holdfast"


def examine(name: str, count: int, seed: int, index: int, strong: bool, presets: bool) -> list[Finding]:
    """What is found out about one configuration of a task; nothing where it can't be made clear."""
    task = load_task(name)
    settings = preset_settings(OWN, task)
    configurations = found(task, count, seed)
    if index >= len(configurations):
        return []
    configuration = configurations[index]
    clear = strengthened(configuration, settings) if strong else as_found(configuration)
    finding: Finding = {"task": name, "strong": strong, "clear": clear is not None}
    if clear is None:
        return [finding]
    approach = find_approach(clear)
    finding |= tested(clear, settings, approach)
    if presets and isinstance(task.test, LiftTest):
        verdicts = {other: preset_verdict(clear, other, approach) for other in preset_names() if other != OWN}
        finding["presets"] = {OWN: finding["held"], **verdicts}
    return [finding]


def tested(configuration: Configuration, settings: HoldSettings, approach: Approach) -> Finding:
    """The verdict on a grasp, those of other settings, and what was known beforehand."""
    squeeze = plan_squeeze(configuration, settings=settings)
    planned = 0.0 if isinstance(squeeze, NotHoldable) else squeeze.load_factor
    measures = {**grasp_quality(configuration, settings=settings).as_record(), "planned_load": planned}
    if isinstance(squeeze, NotHoldable):
        return {"obstacle": squeeze.obstacle.name, "held": False, "measures": measures}
    grasp = Grasp(configuration, squeeze, approach)
    result = hold_test(grasp, settings=settings)
    creep = result.creep_m_s
    return {
        "obstacle": None,
        "held": result.held,
        "outcome": outcome(result),
        "creep_m_s": creep if np.isfinite(creep) else None,
        "others": settings_agreement(grasp, result).variants,
        "measures": measures,
    }


def outcome(result: HoldResult) -> str:
    """The first reason why a grasp failed, or that it held."""
    if not result.kept_place:
        return "moved by the squeeze"
    return next((d.outcome.value for d in result.directions if not d.held), "held")


def preset_verdict(configuration: Configuration, name: str, approach: Approach) -> bool:
    """The verdict of a preset, with a squeeze planned for it."""
    settings = preset_settings(name, configuration.task)
    squeeze = plan_squeeze(configuration, settings=settings)
    return not isinstance(squeeze, NotHoldable) and passes(
        Grasp(configuration, squeeze, approach), settings=settings
    )


def verdicts(arguments: argparse.Namespace) -> None:
    tasks, seed = arguments.tasks or TASKS, arguments.seed
    plan: dict[str, tuple[str, int, int, int, bool, bool]] = {}
    # All tasks in turn, so that one that is stopped has something of each.
    for k in range(max(arguments.count, arguments.plain)):
        for name in tasks:
            if k < arguments.count:
                plan[f"{name} {k}"] = (name, arguments.count, seed, k, True, k < arguments.presets)
            if k < arguments.plain:
                plan[f"{name} {k} as found"] = (name, arguments.plain, seed + 1, k, False, False)
    assumed = {key: getattr(arguments, key) for key in ("seed", "count", "plain", "presets")}
    findings = Findings(arguments.json, assumed)
    whole = findings.collect(plan, examine, arguments.workers, arguments.seconds)
    everything = findings.of(plan)
    clear = [f for f in everything if f["clear"]]
    print_tasks(tasks, everything)
    print_agreement(clear)
    print_measures([f for f in clear if f["strong"]])
    print_presets([f["presets"] for f in clear if "presets" in f])
    if not whole:
        print(f"\nstopped after {len(findings.by_key)} of {len(plan)} configurations; the same call goes on")


def print_tasks(tasks: Iterable[str], everything: list[Finding]) -> None:
    """What became of the strengthened configurations of each task."""
    rows = []
    for name in tasks:
        own = [f for f in everything if f["task"] == name and f["strong"]]
        clear = [f for f in own if f["clear"]]
        held = [f for f in clear if f["held"]]
        named = sum(f["obstacle"] is not None for f in clear)
        creep = max((1e6 * f["creep_m_s"] for f in held if f["creep_m_s"] is not None), default=0.0)
        rows.append((name, *map(str, (len(own), len(clear), named, len(held))), f"{creep:.1f}"))
    print(format_table(("task", "found", "clear", "not holdable", "held", "creep um/s"), rows))


def print_agreement(clear: list[Finding]) -> None:
    """How many verdicts the other settings repeat, and which they do not."""
    tested = [f for f in clear if f["obstacle"] is None]
    print("\nverdicts that all other settings repeat:")
    for held in (True, False):
        same = [f for f in tested if f["held"] == held]
        agreed = sum(set(f["others"].values()) <= {held} for f in same)
        print(f"  {'held' if held else 'failed':8} {agreed} of {len(same)}")
    for f in tested:
        other = [name for name, held in f["others"].items() if held != f["held"]]
        if other:
            print(f"  {f['task']}: {f['outcome']}; otherwise with {', '.join(other)}")


def print_measures(clear: list[Finding]) -> None:
    """How well what is known beforehand predicts the verdict, over all grasps and within their tasks."""
    print(
        "\nAUC against the verdict: over all grasps that are certified and clear; in the mean of the tasks,"
    )
    print("each weighted by its pairs of a grasp that held and one that did not:")
    for name in clear[0]["measures"] if clear else ():
        pooled, within = auc_of(clear, name), auc_within(clear, name)
        print(f"  {name:16}" + "".join("     -" if x is None else f"{x:6.2f}" for x in (pooled, within)))


def auc_of(findings: list[Finding], measure: str) -> float | None:
    scores, held = ([f["measures"][measure] for f in findings], [f["held"] for f in findings])
    return auc(np.array(scores), np.array(held, dtype=bool))


def auc_within(findings: list[Finding], measure: str) -> float | None:
    total = pairs = 0.0
    for task in dict.fromkeys(f["task"] for f in findings):
        own = [f for f in findings if f["task"] == task]
        held = sum(f["held"] for f in own)
        value, weight = auc_of(own, measure), held * (len(own) - held)
        if value is not None:
            total, pairs = total + weight * value, pairs + weight
    return total / pairs if pairs else None


def print_presets(verdicts: list[dict[str, bool]]) -> None:
    """How many grasps each preset holds, and between each two how many only the first holds."""
    names = preset_names()
    print(f"\npresets, {len(verdicts)} grasps of lifts, each with a squeeze of the preset's own plan;")
    print("the columns count grasps that the preset of the row holds and the one of the column does not:")
    rows = []
    for a in names:
        only = [str(sum(v[a] and not v[b] for v in verdicts)) if a != b else "-" for b in names]
        rows.append((a, str(sum(v[a] for v in verdicts)), *only))
    print(format_table(("preset", "held", *names), rows))


def steps_of(result: HoldResult) -> int:
    settings = result.settings
    seconds = settings.close_s + settings.squeeze_s + settings.settle_s
    samples = sum(len(direction.times_s) - 1 for direction in result.directions)
    return round((seconds + samples * settings.sample_s) / settings.timestep_s)


def hold_tests(grasps: list[Grasp], settings: HoldSettings, *, workers: int = 1) -> list[HoldResult]:
    """Tests grasps over `workers` threads: MuJoCo lets go of Python's lock while it steps."""
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(lambda grasp: hold_test(grasp, settings=settings), grasps))


def all_verdicts(grasps: list[Grasp], settings: HoldSettings, workers: int) -> list[bool]:
    """Verdicts of grasps over `workers` threads, and nothing else."""
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(lambda grasp: passes(grasp, settings=settings), grasps))


def timed(work: Callable[[], int]) -> tuple[float, float]:
    """Steps per second of processor time, and per second of the clock."""
    cpu, clock = time.process_time(), time.perf_counter()
    steps = work()
    return steps / (time.process_time() - cpu), steps / (time.perf_counter() - clock)


def speed(arguments: argparse.Namespace) -> None:
    workers = arguments.workers
    for name in arguments.tasks or ["upholding"]:
        task = load_task(name)
        settings = preset_settings(OWN, task)
        placed = (strengthened(c, settings) for c in found(task, arguments.count, arguments.seed))
        clear = [c for c in placed if c is not None]
        plans = [(c, plan_squeeze(c, settings=settings)) for c in clear]
        grasps = [Grasp(c, s) for c, s in plans if not isinstance(s, NotHoldable)]
        results = hold_tests(grasps, settings, workers=workers)
        start, cpu = time.perf_counter(), time.process_time()
        hold_tests(grasps, settings, workers=workers)
        seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu
        print(
            f"{name}: {len(grasps)} grasps, {len(settings.directions)} directions, {workers} threads: "
            f"{len(grasps) / seconds:.2f} grasps/s, {len(grasps) / cpu_seconds:.2f} a core"
        )
        start, cpu = time.perf_counter(), time.process_time()
        verdicts_alone = all_verdicts(grasps, settings, workers)
        seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu
        print(
            f"  verdicts alone: {len(grasps) / seconds:.2f} grasps/s, {len(grasps) / cpu_seconds:.2f} a core"
        )
        assert [result.held for result in results] == verdicts_alone
        compare_engines(grasps, settings, workers)
        assert [result.held for result in results] == [r.held for r in hold_tests(grasps, settings)]


def compare_engines(grasps: list[Grasp], settings: HoldSettings, workers: int) -> None:
    count = round((1.25 + len(settings.directions) * settings.hold_s) / settings.timestep_s)
    ready = [prepared(grasp, settings) for grasp in grasps]
    engines: dict[str, Callable[[], int]] = {
        "plain mj_step": lambda: plain_steps(ready, count, workers),
        "hold test": lambda: sum(map(steps_of, hold_tests(grasps, settings, workers=workers))),
        "mujoco.rollout": lambda: rollout_steps(ready, count, workers),
    }
    # In turns, so that what else the machine does meets all of them.
    rounds = [{label: timed(work) for label, work in engines.items()} for _ in range(ROUNDS)]
    rates = {label: np.median([entry[label] for entry in rounds], axis=0) for label in engines}
    for label, (core, clock) in rates.items():
        print(f"  {label:16} {core:9.0f} steps a core second, {clock:9.0f} a second")
    print(f"  hold test over plain: {rates['hold test'][0] / rates['plain mj_step'][0]:.2f}")


def prepared(grasp: Grasp, settings: HoldSettings) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Model and data after the squeeze, under gravity in the first direction."""
    lift = Lift(grasp, settings)
    lift.squeeze()
    lift.hold(settings.directions[0])
    return lift.simulation.model, lift.simulation.data


def plain_steps(ready: list[tuple[mujoco.MjModel, mujoco.MjData]], count: int, workers: int) -> int:
    """As many bare steps as the hold test makes, of the same models held, without looking at them."""
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda pair: mujoco.mj_step(*pair, count), ready))
    return count * len(ready)


def rollout_steps(ready: list[tuple[mujoco.MjModel, mujoco.MjData]], count: int, workers: int) -> int:
    """The same by mujoco.rollout, which can't stop early and hands back every state."""
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.zeros((len(ready), mujoco.mj_stateSize(ready[0][0], kind)))
    for row, (model, data) in zip(states, ready, strict=True):
        mujoco.mj_getState(model, data, row, kind)
    controls = np.array([np.repeat(data.ctrl[None], count, axis=0) for _, data in ready])
    with mujoco.rollout.Rollout(nthread=workers) as rollout:
        spare = [mujoco.MjData(ready[0][0]) for _ in range(workers)]
        rollout.rollout([model for model, _ in ready], spare, states, controls)
    return count * len(ready)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("mode", nargs="?", choices=MODES, help="one alone; both otherwise")
    parser.add_argument("--tasks", nargs="*", metavar="TASK")
    parser.add_argument("--count", type=int, default=8, help="configurations a task")
    parser.add_argument(
        "--plain", type=int, default=0, help="configurations a task that are not strengthened"
    )
    parser.add_argument("--presets", type=int, default=4, help="configurations a lift that presets compare")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=available_cores())
    parser.add_argument("--seconds", type=float, default=3600.0, help="no work is begun after that")
    parser.add_argument("--json", type=Path, help="findings, to go on with")
    arguments = parser.parse_args()
    if arguments.mode != "verdicts":
        speed(arguments)
    if arguments.mode != "speed":
        verdicts(arguments)


if __name__ == "__main__":
    main()
