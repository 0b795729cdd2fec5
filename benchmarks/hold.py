"""How many grasps pass their task's test, whether other settings agree, and how fast many are tested.

Usage: hold.py [speed | verdicts] [GRASPS A TASK] [TASK ...] [--json FILE]

`verdicts` solves each task (all the built-in ones unless some are named), strengthens and retracts as a run
does, and prints the share of certified and clear grasps that pass; the verdicts at half the time step, with
another solver and twice the no-slip passes; whether grasps without a plan of a squeeze hold all the same; how
well the analytic measures and the planned load predict the outcome (AUC); and the verdicts of all presets.
`speed` counts physics steps in the test of many grasps against plain mj_step with the same model on as many
threads, in steps per second of processor time, which other processes don't disturb, and in wall-clock time.
"""

import json
import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path

import mujoco
import mujoco.rollout
import numpy as np
from holdfast.mjcf import (
    Grasp,
    HoldResult,
    HoldSettings,
    NotHoldable,
    auc,
    grasp_quality,
    hold_test,
    hold_tests,
    plan_squeeze,
    preset_names,
    preset_settings,
    settings_agreement,
    strengthen,
)
from holdfast.mjcf.insist import insist
from holdfast.mjcf.lift import Lift
from holdfast.objects import LiftTest, Task, builtin_tasks, load_task
from holdfast.retraction import ClearConfiguration, retract
from holdfast.solver import Configuration, solve

SEED = 0
ROUNDS = 3
MOST_TURNS = 3
MODES = ("speed", "verdicts")
INSISTENT_N = (3.0, 10.0, 30.0)
MOST_PRESET_GRASPS = 4


@dataclass
class Findings:
    """What was found out about one task."""

    found: int = 0
    certified: int = 0
    unholdable: int = 0
    contradicted: int = 0
    tested: int = 0
    held: int = 0
    agreed: int = 0
    creep_m_s: list[float] = field(default_factory=list)
    scores: dict[str, list[float]] = field(default_factory=dict)
    verdicts: list[bool] = field(default_factory=list)
    presets: dict[str, list[bool]] = field(default_factory=dict)


def placed(task: Task, count: int) -> tuple[int, list[Configuration]]:
    """Configurations found, and those of them that are certified and clear."""
    found = solve(task, candidates=count, seed=SEED, budget_s=60.0).configurations
    clear = []
    settings = preset_settings("holdfast", task)
    for configuration in found:
        last = placed_by_turns(configuration, settings)
        if last is not None and last.certified:
            clear.append(last)
    return len(found), clear


def placed_by_turns(configuration: Configuration, settings: HoldSettings) -> Configuration | None:
    """Strengthening and retraction in turns, as a run does; None where the first turn does not end clear."""
    last = None
    for _ in range(MOST_TURNS):
        stronger = strengthen(configuration, settings)
        if last is not None and stronger is configuration:
            break
        outcome = retract(stronger)
        if not isinstance(outcome, ClearConfiguration):
            break
        configuration = last = outcome.configuration
    return last


def examine(task: Task, count: int) -> Findings:
    settings = preset_settings("holdfast", task)
    findings = Findings()
    findings.found, clear = placed(task, count)
    findings.certified = len(clear)
    for configuration in clear:
        squeeze = plan_squeeze(configuration, settings)
        if isinstance(squeeze, NotHoldable):
            findings.unholdable += 1
            findings.contradicted += is_contradicted(configuration, settings)
            load, held = squeeze.load_factor, False
        else:
            result = hold_test(Grasp(configuration, squeeze), settings)
            load, held = squeeze.load_factor, result.held
            findings.tested += 1
            findings.held += held
            findings.agreed += settings_agreement(Grasp(configuration, squeeze), result).agree
            if held:
                findings.creep_m_s.append(result.creep_m_s)
        measures = {**grasp_quality(configuration, settings).as_record(), "planned_load": load}
        for name, value in measures.items():
            findings.scores.setdefault(name, []).append(value)
        findings.verdicts.append(held)
    if isinstance(task.test, LiftTest):
        compare_presets(clear[:MOST_PRESET_GRASPS], findings)
    return findings


def is_contradicted(configuration: Configuration, settings: HoldSettings) -> bool:
    """Whether a grasp that statics calls not holdable is held by a hand that presses all the same."""
    if not isinstance(configuration.task.test, LiftTest):
        return False
    squeezes = (insist(configuration, force, settings) for force in INSISTENT_N)
    return any(hold_test(Grasp(configuration, squeeze), settings).held for squeeze in squeezes)


def compare_presets(configurations: list[Configuration], findings: Findings) -> None:
    for name in preset_names():
        verdicts = findings.presets.setdefault(name, [])
        for configuration in configurations:
            settings = preset_settings(name, configuration.task)
            squeeze = plan_squeeze(configuration, settings)
            planned = not isinstance(squeeze, NotHoldable)
            verdicts.append(planned and hold_test(Grasp(configuration, squeeze), settings).held)


def verdicts(count: int, names: list[str], json_path: Path | None = None) -> None:
    columns = ("found", "clear", "no plan", "contradicted", "tested", "held", "agree", "creep um/s")
    print(f"{'task':16}" + "".join(f"{name:>13}" for name in columns), flush=True)
    everything: list[Findings] = []
    tasks = names or list(builtin_tasks())
    for name in tasks:
        findings = examine(load_task(name), count)
        everything.append(findings)
        if json_path is not None:  # after each task: a run that is cut short leaves what it has
            record = {task: asdict(entry) for task, entry in zip(tasks, everything, strict=False)}
            json_path.write_text(json.dumps(record, indent=1) + "\n", "utf-8")
        creep = f"{1e6 * max(findings.creep_m_s):.1f}" if findings.creep_m_s else "-"
        cells = (findings.found, findings.certified, findings.unholdable, findings.contradicted)
        cells += (findings.tested, findings.held, findings.agreed, creep)
        print(f"{name:16}" + "".join(f"{cell!s:>13}" for cell in cells), flush=True)
    summarise(everything)


def summarise(everything: list[Findings]) -> None:
    tested, agreed = sum(f.tested for f in everything), sum(f.agreed for f in everything)
    unholdable, contradicted = sum(f.unholdable for f in everything), sum(f.contradicted for f in everything)
    print(f"\nverdicts that other settings repeat: {agreed} of {tested}")
    print(f"grasps without a plan that hold all the same: {contradicted} of {unholdable}")
    print("\nAUC against the simulated verdict, over all grasps that are certified and clear:")
    held = np.array([v for f in everything for v in f.verdicts])
    for name in everything[0].scores:
        value = auc(np.array([s for f in everything for s in f.scores.get(name, [])]), held)
        print(f"  {name:16}{'-' if value is None else f'{value:.2f}'}")
    print("\nverdicts of the presets, each with a squeeze of its own plan (of the lifts):")
    table = {name: [v for f in everything for v in f.presets.get(name, [])] for name in preset_names()}
    for name, own in table.items():
        differ = "".join(
            f"{sum(a != b for a, b in zip(own, other, strict=True)):>15}" for other in table.values()
        )
        print(f"  {name:14} held {sum(own):3} of {len(own):3}; differs from" + differ)


def steps_of(result: HoldResult) -> int:
    settings = result.settings
    seconds = settings.close_s + settings.squeeze_s + settings.settle_s
    samples = sum(len(direction.times_s) - 1 for direction in result.directions)
    return round((seconds + samples * settings.sample_s) / settings.timestep_s)


def timed(work: Callable[[], int]) -> tuple[float, float]:
    """Steps per second of processor time, and per second of the clock."""
    cpu, clock = time.process_time(), time.perf_counter()
    steps = work()
    return steps / (time.process_time() - cpu), steps / (time.perf_counter() - clock)


def speed(count: int, names: list[str]) -> None:
    workers = os.cpu_count() or 1
    for name in names or ["upholding"]:
        task = load_task(name)
        settings = preset_settings("holdfast", task)
        _, clear = placed(task, count)
        plans = [(c, plan_squeeze(c, settings)) for c in clear]
        grasps = [Grasp(c, s) for c, s in plans if not isinstance(s, NotHoldable)]
        results = hold_tests(grasps, settings, workers=workers)
        start, cpu = time.perf_counter(), time.process_time()
        hold_tests(grasps, settings, workers=workers)
        seconds, cpu_seconds = time.perf_counter() - start, time.process_time() - cpu
        print(
            f"{name}: {len(grasps)} grasps, {len(settings.directions)} directions, {workers} threads: "
            f"{len(grasps) / seconds:.2f} grasps/s, {len(grasps) / cpu_seconds:.2f} a core"
        )
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


def main(arguments: list[str]) -> None:
    json_path = None
    if "--json" in arguments:
        at = arguments.index("--json")
        json_path = Path(arguments[at + 1])
        arguments = arguments[:at] + arguments[at + 2 :]
    modes = [word for word in arguments if word in MODES] or list(MODES)
    counts = [int(word) for word in arguments if word.isdigit()]
    names = [word for word in arguments if word not in MODES and not word.isdigit()]
    if "speed" in modes:
        speed(counts[0] if counts else 8, names)
    if "verdicts" in modes:
        verdicts(counts[0] if counts else 12, names, json_path)


if __name__ == "__main__":
    main(sys.argv[1:])
