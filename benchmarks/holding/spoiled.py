"""Grasps that fail: those of runs, each spoiled once at random, for `second_engine` to judge.

Usage: ./run bench spoiled RUN ... --out FOLDER [--seed N]

One thing of each grasp is changed, drawn by the seed and the grasp's name: the load of a lift, 1.5 to 8 times
as large (even in its logarithm); the friction, to 0.3 to 0.9 of it; or the squeeze, to 0.1 to 0.9 of it. The
grasp is put to its test again. Where it fails, its file with the new test is written to FOLDER/RUN/grasps,
beside a copy of run.json, so that `second_engine FOLDER/*` finds it. Printed is how many of each run fail.
"""

import argparse
import shutil
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
from holdfast.base.files.output_file import write_text
from holdfast.grasping import ReadyGrasp, Trial
from holdfast.mjcf import Grasp, hold_test
from holdfast.objects import LiftTest
from holdfast.pipeline.records import GraspFile, load_grasp_task, read_grasp, relative_source, resolve_source
from holdfast.pipeline.run import to_grasp
from holdfast.pipeline.run.stages import with_trial
from parts.neutral_scene import settings_of

LIFTS, OTHERS = ("load", "friction", "squeeze"), ("friction", "squeeze")


def spoiled(path: Path, seed: str) -> tuple[GraspFile, bool] | None:
    """A grasp with one thing changed, and whether it holds; None where it can't be put to its test."""
    record = read_grasp(path)
    if record.hold is None or not record.hold.directions:
        return None
    task, settings = load_grasp_task(record, path), settings_of(record.hold.settings)
    draw, share = Random(seed), 1.0
    match draw.choice(LIFTS if isinstance(task.test, LiftTest) else OTHERS):
        case "load":
            times = float(np.exp(draw.uniform(np.log(1.5), np.log(8.0))))
            settings = replace(settings, gravity=times * settings.gravity)
        case "friction":
            friction = draw.uniform(0.3, 0.9) * settings.sliding_friction(task.object)
            settings = replace(settings, friction=friction)
        case _:
            share = draw.uniform(0.1, 0.9)
    grasp = to_grasp(record, task, settings, path)
    if grasp is None:
        return None
    grasp = squeezed_less(grasp, share)
    trial = Trial(ReadyGrasp(grasp), hold_test(grasp, settings=settings))
    return with_trial(record, trial), trial.held


def squeezed_less(grasp: Grasp, share: float) -> Grasp:
    """The grasp with a share of its squeeze, from which a turn then goes on as far as planned."""
    squeeze = grasp.squeeze
    back = (1.0 - share) * (squeeze.targets - grasp.configuration.state.q)
    path = squeeze.path - back if len(squeeze.path) else squeeze.path
    weaker = replace(squeeze, targets=squeeze.targets - back, path=path)
    return replace(grasp, squeeze=weaker, known_approach=grasp.approach)


def spoil(run: Path, out: Path, seed: int) -> tuple[int, int]:
    """How many grasps of a run were put to the test again, and how many of them failed and are written."""
    tried = failed = 0
    for path in sorted((run / "grasps").glob("*.json")):
        found = spoiled(path, f"{seed} {run.name}/{path.stem}")
        if found is None:
            continue
        grasp, held = found
        tried += 1
        if held:
            continue
        failed += 1
        there = out / run.name / "grasps" / path.name
        source = relative_source(resolve_source(grasp.task_source, path), there)
        there.parent.mkdir(parents=True, exist_ok=True)
        write_text(there, grasp.model_copy(update={"task_source": source}).model_dump_json(indent=1))
    if failed:
        shutil.copyfile(run / "run.json", out / run.name / "run.json")
    return tried, failed


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="run folders")
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER", help="where the failed ones go")
    parser.add_argument("--seed", type=int, default=0, help="of what is changed")
    arguments = parser.parse_args()
    for run in arguments.runs:
        tried, failed = spoil(run, arguments.out, arguments.seed)
        print(f"{run.name}: {failed} of {tried} fail", flush=True)


if __name__ == "__main__":
    main()
