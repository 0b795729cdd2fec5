"""Sound grasps to plant faults in: certified, clear, able to carry their load; solved for once and kept."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from holdfast.mjcf import preset_settings, start_strengths, strengthen
from holdfast.objects import Task, load_task
from holdfast.retraction import ClearConfiguration, retract
from holdfast.solver import Configuration, ContactManifold, State, solve
from parts.places import ROOT

PINCH = str(ROOT / "examples" / "hands" / "pinch.yaml")
TASKS = (
    "upholding",
    "handling",
    "lid_lifting",
    "service",
    str(ROOT / "examples" / "jaw" / "grip.yaml"),
    PINCH,
    "upholding@shadow",
    f"{PINCH}@shadow",
)
# Tasks and the models, below a folder of public ones, of the hands that are to do them.
IMPORTED = (
    ("upholding", "allegro_hand/allegro_hand_right.urdf"),
    (PINCH, "leap_hand/leap_hand_right.urdf"),
)
# Of so many candidates for each one that is wanted some can't be freed, or carry nothing.
_SPARE = 3


@dataclass(frozen=True, eq=False)
class Sound:
    """A grasp of ours with its task."""

    configuration: Configuration

    @property
    def task(self) -> Task:
        return self.configuration.task


def sound_grasps(count: int, seed: int, models: Path, kept: Path | None) -> list[Sound]:
    """So many, in turns of the tasks; from the file `kept` where it has them, else written to it."""
    names = [*TASKS, *(f"{task}@{models / model}" for task, model in IMPORTED if (models / model).exists())]
    share = -(-count // len(names))
    stored: dict[str, Any] = {}
    if kept is not None and kept.exists():
        stored = json.loads(kept.read_text("utf-8"))
    key = f"{seed}"
    by_task = []
    for name in names:
        task = load_task(name)
        known = stored.setdefault(key, {}).setdefault(name, {"asked": 0, "states": []})
        # A task that has fewer than were asked for has no more.
        if known["asked"] < share:
            known |= {"asked": share, "states": [_plain(found.state) for found in _found(task, share, seed)]}
            if kept is not None:
                kept.write_text(json.dumps(stored), "utf-8")
        by_task.append([Sound(_configuration(task, state)) for state in known["states"][:share]])
    return [found[k] for k in range(share) for found in by_task if k < len(found)][:count]


def _found(task: Task, wanted: int, seed: int) -> Iterator[Configuration]:
    """Certified configurations that are clear, and whose contacts carry the load of their task's test."""
    settings = preset_settings("holdfast", task)
    whole = replace(settings, planned_friction=1.0)
    result = solve(task, candidates=_SPARE * wanted, seed=seed, budget_s=60.0)
    for configuration in result.configurations:
        outcome = retract(strengthen(configuration, settings=settings))
        if not isinstance(outcome, ClearConfiguration) or not outcome.configuration.certified:
            continue
        if start_strengths([outcome.configuration], settings=whole)[0] < 1.0:
            continue
        yield outcome.configuration
        wanted -= 1
        if not wanted:
            return


def _plain(state: State) -> list[list[float]]:
    parts: Sequence[np.ndarray] = (state.q, state.R_palm_object.ravel(), state.p_palm_object, state.params)
    return [part.tolist() for part in parts]


def _configuration(task: Task, plain: list[list[float]]) -> Configuration:
    q, R, p, params = (np.array(part) for part in plain)
    state = State(q, R.reshape(3, 3), p, params)
    return Configuration(task, state, ContactManifold(task).error_m(state), None)
