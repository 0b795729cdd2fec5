"""Hands as their authors publish them, no coordinate written by hand: imported, solved and held.

    python benchmarks/hands_public.py [FOLDER ...] [--budget S] [--objects can,box,ball] [--only WORD]

Every MJCF or URDF model of a hand below the folders is taken as it is: copies of public collections such as
dex-urdf or mujoco_menagerie, or the cache of robot_descriptions. Without a folder, ../shared/models is taken.
A can, a box and a ball of 100 g are grasped in one command each, until one grasp holds.
"""

import argparse
import re
import tempfile
import time
from pathlib import Path

import trimesh
from holdfast.errors import HoldfastError
from holdfast.hands import Hand, load_hand
from holdfast.pipeline.run import RunSettings
from holdfast.pipeline.run_object import ObjectSource, run_object

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared" / "models"
MASS_KG, FRICTION = 0.1, 0.8
# What is no hand by itself: scenes, parts that are included, and pieces of whole robots.
NO_HAND = re.compile(
    r"scene|_asset|_body|_actuator|_contact|_sensor|defaults|options|package|launch|keyframe"
)


def objects() -> dict[str, trimesh.Trimesh]:
    return {
        "can": trimesh.creation.cylinder(0.03, 0.1, sections=64),
        "box": trimesh.creation.box([0.05, 0.06, 0.09]),
        "ball": trimesh.creation.icosphere(subdivisions=4, radius=0.03),
    }


def models(folders: list[Path]) -> list[Path]:
    found = [p for folder in folders for p in folder.rglob("*") if p.suffix in (".urdf", ".xml", ".mjcf")]
    return sorted(p for p in found if not NO_HAND.search(p.stem) and _is_model(p))


def _is_model(path: Path) -> bool:
    head = path.read_text("utf-8", errors="replace")
    return "<robot" in head or "<worldbody" in head


def grasp(model: Path, mesh: Path, folder: Path, budget_s: float) -> tuple[bool, bool, float]:
    """Whether a configuration was certified, whether a grasp held, and the time."""
    started = time.monotonic()
    source = ObjectSource(mesh, str(model), mass_kg=MASS_KG, friction=FRICTION)
    done = run_object(source, folder / "run", RunSettings(candidates=8, budget_s=budget_s, wanted=1))
    return bool(done.suggested), done.is_held, time.monotonic() - started


def row(hand: Hand, model: Path, names: list[str], budget_s: float) -> tuple[list[str], int, int]:
    cells, solved, held = [], 0, 0
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / f"{name}.stl"
            objects()[name].export(mesh)
            try:
                is_solved, is_held, seconds = grasp(model, mesh, Path(folder), budget_s)
            except HoldfastError as error:
                cells.append(f"refused: {str(error)[:80]}")
                continue
        solved, held = solved + is_solved, held + is_held
        cells.append(f"{'held' if is_held else 'solved' if is_solved else 'no'}, {seconds:.0f} s")
    return cells, solved, held


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=[SHARED], metavar="FOLDER")
    parser.add_argument("--budget", type=float, default=120.0, help="seconds for each object")
    parser.add_argument("--objects", default="can,box,ball")
    parser.add_argument("--only", default="", help="models alone whose path holds this word")
    parser.add_argument("--import-only", action="store_true")
    arguments = parser.parse_args()
    names = [] if arguments.import_only else arguments.objects.split(",")
    imported = tried = n_solved = n_held = 0
    print(f"| hand | degrees of freedom | regions | import s | {' | '.join(names)} |")
    print("|---|---|---|---|" + "---|" * len(names))
    for model in models(arguments.folders):
        if arguments.only not in str(model):
            continue
        tried += 1
        started = time.monotonic()
        try:
            hand = load_hand(model)
        except HoldfastError as error:
            print(f"| {model.stem} | refused: {str(error).replace(str(model), '')[:160]} |", flush=True)
            continue
        imported += 1
        seconds = time.monotonic() - started
        cells, solved, held = row(hand, model, names, arguments.budget)
        n_solved, n_held = n_solved + (solved > 0), n_held + (held > 0)
        cells = [str(len(hand.independent)), str(len(hand.regions)), f"{seconds:.1f}", *cells]
        print(f"| {model.stem} | {' | '.join(cells)} |", flush=True)
    print(f"\n{imported} of {tried} imported, {n_solved} solved, {n_held} held something")


if __name__ == "__main__":
    main()
