"""Hands as their authors publish them, no coordinate written by hand: imported, solved and held.

    ./run bench hands_public [FOLDER ...] [--budget S] [--objects can,box,ball] [--only WORD]
        [--json FILE]

Every MJCF or URDF model of a hand below the folders is taken as it is: copies of public collections such as
dex-urdf or mujoco_menagerie, or the cache of robot_descriptions. Without a folder, ../shared/models is taken.
A can, a box and a ball of 100 g are grasped until one grasp holds, each in a process of its own. Seconds are
by the clock, and those of the processor behind them. With --json findings are kept as they come, and a call
that was stopped can be repeated to go on.
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import trimesh
from holdfast.base.files.file_paths import ROOT_VARIABLE
from holdfast.errors import HoldfastError
from holdfast.hands import load_hand
from holdfast.pipeline.run import RunSettings
from holdfast.pipeline.run_object import GraspRequest, run_object
from parts.places import RUN, SHARED

MODELS = SHARED / "models"
MASS_KG, FRICTION = 0.1, 0.8
# Few at once, for one that holds is enough.
CANDIDATES = 2
# What is no hand by itself: scenes, parts that are included, and pieces of whole robots.
NO_HAND = re.compile(
    r"scene|_asset|_body|_actuator|_contact|_sensor|defaults|options|package|launch|keyframe"
)
OBJECTS = {
    "can": trimesh.creation.cylinder(0.03, 0.1, sections=64),
    "box": trimesh.creation.box([0.05, 0.06, 0.09]),
    "ball": trimesh.creation.icosphere(subdivisions=4, radius=0.03),
}
# A process that takes so much longer than its budget hangs.
PATIENCE, PATIENCE_S = 3.0, 120.0

Finding = dict[str, Any]


def models(folders: list[Path]) -> list[Path]:
    found = [p for folder in folders for p in folder.rglob("*") if p.suffix in (".urdf", ".xml", ".mjcf")]
    return sorted(p for p in found if not NO_HAND.search(p.stem) and _is_model(p))


def _is_model(path: Path) -> bool:
    head = path.read_text("utf-8", errors="replace")
    return "<robot" in head or ("<mujoco" in head and "<worldbody" in head and "<mujocoinclude" not in head)


def read(model: Path) -> Finding:
    """What the import makes of a model."""
    started = time.monotonic()
    try:
        hand = load_hand(model)
    except HoldfastError as error:
        return {"refused": str(error).replace(str(model), "")}
    coupled = sum(axis.coupling is not None for axis in hand.axes)
    return {
        "joints": len(hand.independent),
        "coupled": coupled,
        "regions": len(hand.regions),
        "seconds": time.monotonic() - started,
        "cpu_s": _cpu_s(),
    }


def grasp(model: Path, name: str, budget_s: float) -> Finding:
    """Whether a configuration was certified, whether a grasp held, and what that took."""
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / f"{name}.stl"
        OBJECTS[name].export(mesh)
        request = GraspRequest(str(mesh), str(model), mass_kg=MASS_KG, friction=FRICTION)
        # Verdicts alone: margins and pictures come after the first held grasp, which is what is timed.
        settings = RunSettings(candidates=CANDIDATES, budget_s=budget_s, wanted=1, quick=True)
        try:
            done = run_object(request, Path(folder) / "run", settings)
        except HoldfastError as error:
            return {"refused": str(error).replace(str(model), "")}
    certified = any(grasp.certified for attempt in done.attempts for grasp in attempt.record.grasps)
    # The search for contacts certifies too, before it looks whether anything is in the way.
    reached = any(tried.tasks > tried.unreached for tried in done.tried)
    end = "held" if done.is_held else "solved" if certified or reached else "no"
    seconds = time.monotonic() - started
    return {"end": end, "seconds": seconds, "cpu_s": _cpu_s(), "words": str(done)}


def _cpu_s() -> float:
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(part.ru_utime + part.ru_stime for part in used)


def in_process(model: Path, folder: Path, step: str, budget_s: float) -> Finding:
    """`read`, or `grasp` of an object, in a process of its own that may read files below the folder."""
    command = [
        sys.executable,
        "-P",
        str(RUN),
        "hands_public",
        str(model),
        "--step",
        step,
        "--budget",
        str(budget_s),
    ]
    environment = os.environ | {ROOT_VARIABLE: str(folder.resolve())}
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=PATIENCE * budget_s + PATIENCE_S,
            check=False,
            env=environment,
        )
    except subprocess.TimeoutExpired:
        return {"end": "hung"}
    if done.returncode:
        return {"end": f"crashed ({done.returncode})", "words": done.stderr[-400:]}
    return dict(json.loads(done.stdout.splitlines()[-1]))


def cell(found: Finding) -> str:
    if "refused" in found:
        return f"refused: {found['refused'][:160]}"
    return found["end"] + (f", {found['seconds']:.0f} / {found['cpu_s']:.0f} s" if "seconds" in found else "")


def row(model: Path, imported: Finding, found: list[Finding]) -> str:
    if "regions" not in imported:
        return f"| {model.stem} | {cell(imported)} |"
    joints = f"{imported['joints']} + {imported['coupled']}"
    took = f"{imported['seconds']:.1f} / {imported['cpu_s']:.1f}"
    return f"| {' | '.join([model.stem, joints, str(imported['regions']), took, *map(cell, found)])} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=[MODELS], metavar="FOLDER")
    parser.add_argument("--budget", type=float, default=120.0, help="seconds for each object")
    parser.add_argument("--objects", default="can,box,ball")
    parser.add_argument("--only", default="", help="models alone whose path holds this word")
    parser.add_argument("--import-only", action="store_true")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--step", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.step:
        model = arguments.folders[0]
        step = arguments.step
        print(json.dumps(read(model) if step == "read" else grasp(model, step, arguments.budget)))
        return
    names = [] if arguments.import_only else arguments.objects.split(",")
    kept = arguments.json
    known: dict[str, Finding] = json.loads(kept.read_text("utf-8")) if kept and kept.is_file() else {}

    def find(model: Path, folder: Path, step: str) -> Finding:
        key = f"{model} {step} {arguments.budget if step != 'read' else ''}".strip()
        if key not in known:
            known[key] = in_process(model, folder, step, arguments.budget)
            if kept:
                kept.write_text(json.dumps(known, indent=1), "utf-8")
        return known[key]

    n_imported = n_solved = n_held = tried = 0
    print(f"| hand | joints + coupled | regions | import s / CPU s | {' | '.join(names)} |")
    print("|---|---|---|---|" + "---|" * len(names))
    for folder in arguments.folders:
        for model in models([folder]):
            if arguments.only not in str(model):
                continue
            tried += 1
            imported = find(model, folder, "read")
            found = [find(model, folder, name) for name in names] if "regions" in imported else []
            ends = [finding.get("end") for finding in found]
            n_imported += "regions" in imported
            n_solved += "held" in ends or "solved" in ends
            n_held += "held" in ends
            print(row(model, imported, found), flush=True)
    print(f"\n{n_imported} of {tried} imported, {n_solved} solved, {n_held} held something")


if __name__ == "__main__":
    main()
