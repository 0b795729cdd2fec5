"""Candidates in files: all that a physical test needs, so that nothing is solved or planned again."""

from pathlib import Path

import numpy as np

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel
from ...errors import InputError
from ...grasping import ReadyGrasp
from ...mjcf import Grasp, HoldSettings, Squeeze
from ...objects import Task
from ...solver import Configuration
from ..records import Approach, Solution, approach_record, to_approach, to_solution, to_state

__all__ = ["StoredCandidate", "StoredSqueeze", "stored", "to_grasp"]


class StoredSqueeze(FileModel):
    """A squeeze; lists go by the hand's independent joints, or by the task's contacts."""

    targets: list[Finite]
    efforts: list[Finite]
    forces: list[tuple[Finite, Finite, Finite, Finite]]
    load_factor: Finite
    spin_arms: list[Finite]
    yields: list[Finite]
    centres: list[tuple[Finite, Finite]]
    path: list[list[Finite]] = []


class StoredCandidate(FileModel):
    """A candidate that is certified and clear, with its squeeze.

    Attributes:
        solution: hand and object.
        clearance: smallest distance between bodies that should not touch, in m.
        approach: how the fingers get there.
        squeeze: how the hand presses.
        features: as `candidate_features` has them, those of joints that the hand lacks left out.
    """

    solution: Solution
    clearance: Finite
    approach: Approach
    squeeze: StoredSqueeze
    features: list[Finite]


def stored(ready: ReadyGrasp, identifier: str, clearance_m: float, features: list[float]) -> StoredCandidate:
    """The written form of a candidate."""
    squeeze, hand = ready.squeeze, ready.configuration.task.hand
    return StoredCandidate(
        solution=to_solution(ready.configuration, identifier),
        clearance=clearance_m,
        approach=approach_record(ready.approach, hand),
        squeeze=StoredSqueeze(
            targets=squeeze.targets.tolist(),
            efforts=squeeze.efforts.tolist(),
            forces=squeeze.preload.tolist(),
            load_factor=squeeze.load_factor,
            spin_arms=squeeze.spin_arms_m.tolist(),
            yields=squeeze.yields_m.tolist(),
            centres=squeeze.centres_m.tolist(),
            path=squeeze.path.tolist() if squeeze.path.size else [],
        ),
        features=features,
    )


def to_grasp(candidate: StoredCandidate, task: Task, settings: HoldSettings, source: str | Path) -> Grasp:
    """The grasp of a written candidate, as it was tried: its proof is taken on trust.

    Raises:
        InputError: a candidate that is none of this task.
    """
    squeeze = candidate.squeeze
    joints, contacts = len(task.hand.independent), len(task.contacts)
    counts = {"targets": joints, "efforts": joints}
    counts |= dict.fromkeys(("forces", "spin_arms", "yields", "centres"), contacts)
    for name, count in counts.items():
        if len(getattr(squeeze, name)) != count:
            raise InputError(source, f"squeeze.{name}", f"must have {count} entries for task {task.name}")
    if any(len(place) != joints for place in squeeze.path):
        raise InputError(source, "squeeze.path", f"must have {joints} joints a place")
    state = to_state(candidate.solution, task, source)
    return Grasp(
        Configuration(task, state, candidate.solution.residual, None),
        Squeeze(
            targets=np.array(squeeze.targets),
            efforts=np.array(squeeze.efforts),
            preload=np.array(squeeze.forces),
            loaded=np.zeros((0, contacts, 4)),
            load_factor=squeeze.load_factor,
            settings=settings,
            spin_arms_m=np.array(squeeze.spin_arms),
            yields_m=np.array(squeeze.yields),
            centres_m=np.array(squeeze.centres),
            path=np.array(squeeze.path) if squeeze.path else np.zeros((0, 0)),
        ),
        to_approach(candidate.approach, task.hand, source),
    )
