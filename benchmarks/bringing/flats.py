"""Flat pads of parallel jaws: certified, refuted or open, by the room that normals have, and whole runs.

Usage: ./run bench flats [--models DIR] [--runs N] [--budget S] [--seed N]

With --models the published Franka gripper and Robotiq 2F-140 in that folder are tried as well. With --runs N
configurations of each gripper on each thing are cleared and held.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from holdfast.base.text.console import format_table
from holdfast.grasping import Refusal, make_grasp, try_hold
from holdfast.hands import Hand
from holdfast.objects import Task
from holdfast.solver import SolveResult, solve
from parts.jaws import OBJECTS, PUBLIC, jaw, jaw_task, public_hand, thing

# Rooms of the table, in degrees; None for the usual.
ROOMS: tuple[float | None, ...] = (None, 0.0, 1.0)
# What is held in whole runs, with the room that it needs: the sides of the cone are 10 deg off.
HELD = {"can": None, "box": None, "sheet": None, "tin ends": None, "cone": 12.0}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--models", type=Path)
    parser.add_argument("--runs", type=int, default=0)
    parser.add_argument("--budget", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    with TemporaryDirectory() as name:
        folder = Path(name)
        print(_solved(folder, arguments.budget, arguments.seed, arguments.models))
        if arguments.runs:
            print()
            print(_held(folder, arguments.runs, arguments.seed, arguments.models))


def _hands(folder: Path, models: Path | None) -> Iterator[tuple[str, Hand]]:
    yield "jaw", jaw(folder / "jaw")
    if models is not None:
        for name in PUBLIC:
            yield name, public_hand(name, models, folder)


def _solved(folder: Path, budget_s: float, seed: int, models: Path | None) -> str:
    """What the solver says of each pair of a gripper and a thing."""
    hands = [*_hands(folder, models), ("tilted by 1 deg", jaw(folder / "tilted", tilt_deg=1.0))]
    rows = []
    for label, hand in hands:
        for name in OBJECTS:
            obj = thing(name, folder / "things")
            results = [
                solve(jaw_task(hand, obj, room), candidates=4, seed=seed, budget_s=budget_s) for room in ROOMS
            ]
            rows.append((label, name, *map(_said, results)))
    head = ["usual" if room is None else "exact" if room == 0.0 else f"{room:g} deg" for room in ROOMS]
    return str(format_table(("gripper", "thing", *head), rows))


def _said(result: SolveResult) -> str:
    count = f"{result.boxes} boxes, {result.lps} LPs"
    if result.verdict.value != "solved":
        return f"{result.verdict.value}, {count}"
    certified = [c.certificate for c in result.configurations if c.certificate is not None]
    off = max((max(c.opposed_within_rad) for c in certified), default=0.0)
    said = f"within {np.rad2deg(off):.1e} deg" if off else "exactly"
    return f"{len(certified)} in {count}, {said}"


def _held(folder: Path, count: int, seed: int, models: Path | None) -> str:
    """Configurations, those that came clear, and those that held."""
    rows = []
    for label, hand in _hands(folder, models):
        for name, room in HELD.items():
            task = jaw_task(hand, thing(name, folder / "things"), room)
            rows.append((label, name, *_tried(task, count, seed)))
    return str(format_table(("gripper", "thing", "certified", "clear", "held", "said of the others"), rows))


def _tried(task: Task, count: int, seed: int) -> tuple[str, ...]:
    found = [c for c in solve(task, candidates=count, seed=seed).configurations if c.certified]
    clear = held = 0
    others = []
    for configuration in found:
        made = make_grasp(configuration)
        if isinstance(made, Refusal):
            clear += made.clearing is not None and made.clearing.is_clear
            others.append(str(made.reason))
            continue
        clear += 1
        trial = try_hold(made)
        held += trial.held
        if not trial.held:
            others.append(str(trial))
    return f"{len(found)}", f"{clear}", f"{held}", "; ".join(dict.fromkeys(others))


if __name__ == "__main__":
    main()
