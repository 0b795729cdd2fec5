"""One situation of a data set, made: its candidates, what was drawn, and how each of them fared."""

import zlib
from pathlib import Path

import numpy as np

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel, parse
from ...base.files.json_file import read_json
from ...errors import InputError
from ...mjcf import kind_of_test, preset_settings
from ..choice import (
    Situation,
    StoredCandidate,
    category,
    draw,
    find_situation,
    make_candidates,
    object_features,
    to_grasp,
    try_under,
)
from ..records import fingerprint
from .plan import DatasetPlan, SituationPlan

__all__ = ["Outcome", "Part", "Told", "make_part", "read_part"]


class Told(FileModel):
    """What is told of hand, object and task."""

    hand: str
    hand_hash: str
    object: str
    family: str
    kind: str
    contacts: int
    test: str
    object_features: list[Finite]


class Outcome(FileModel):
    """How a candidate fared under a draw at a load."""

    held: bool
    margin: Finite
    outcome: str


class Part(FileModel):
    """A situation; without candidates, why there are none.

    Attributes:
        plan: object and hand, as asked for.
        rank: see `SituationPlan`.
        seed: of the data set.
        situation: how to come by its task; None where none was found.
        told: of hand, object and task.
        candidates: what can be tried.
        conditions: (D, C) what was drawn.
        outcomes: by candidate, draw and load.
        refused: why others could not be tried, counted.
    """

    plan: tuple[str, str]
    rank: int
    seed: int = 0
    situation: Situation | None = None
    told: Told | None = None
    candidates: list[StoredCandidate] = []
    conditions: list[list[Finite]] = []
    outcomes: list[list[list[Outcome]]] = []
    refused: dict[str, int] = {}


def read_part(path: Path) -> Part:
    """Reads a part.

    Raises:
        InputError: a file that is none.
    """
    return parse(Part, read_json(path), path)


def make_part(planned: SituationPlan, plan: DatasetPlan) -> Part:
    """Makes a part; the same for the same plan, whatever else is made."""
    blank = Part(plan=(planned.object, planned.hand), rank=planned.rank, seed=plan.seed)
    seed = zlib.crc32(f"{plan.seed} {planned.object} {planned.hand}".encode())
    try:
        found = find_situation(planned.object, planned.hand, seed=seed % 2**16)
    except InputError as error:  # such as a hand without the regions of a task
        return blank.model_copy(update={"refused": {str(error): 1}})
    if found is None:
        return blank.model_copy(update={"refused": {"no contacts found": 1}})
    situation, task = found
    settings = preset_settings("holdfast", task)
    made = make_candidates(task, plan.candidates, seed=seed % 2**31, settings=settings)
    rng = np.random.default_rng([plan.seed, seed])
    conditions = [draw(rng, task.object, plan.ranges) for _ in range(plan.draws)]
    outcomes = []
    for candidate in made.candidates:
        # Of its written form, as whoever replays it has it.
        grasp = to_grasp(candidate, task, settings, "part")
        outcomes.append(
            [
                [Outcome(**trial._asdict()) for trial in try_under(grasp, drawn, plan.loads, settings)]
                for drawn in conditions
            ]
        )
    told = Told(
        hand=task.hand.name,
        hand_hash=fingerprint(task.hand),
        object=task.object.name,
        family=category(planned.object),
        kind=f"{category(planned.object)}-{len(task.contacts)}",
        contacts=len(task.contacts),
        test=kind_of_test(task),
        object_features=object_features(task.object).astype(float).tolist(),
    )
    return blank.model_copy(
        update={
            "situation": situation,
            "told": told,
            "candidates": list(made.candidates),
            "conditions": [drawn.astype(float).tolist() for drawn in conditions],
            "outcomes": outcomes,
            "refused": made.refused,
        }
    )
