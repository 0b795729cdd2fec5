"""Which grasp of a run comes first."""

import random

import pytest
from holdfast.pipeline.records import GraspRecord, RunRecord
from holdfast.pipeline.run.ranking import rank


def changed(grasp: GraspRecord, identifier: str, hold: dict[str, object], clearance: float) -> GraspRecord:
    assert grasp.hold is not None and grasp.clearance is not None
    return grasp.model_copy(
        update={
            "id": identifier,
            "hold": grasp.hold.model_copy(update=hold),
            "clearance": grasp.clearance.model_copy(update={"after": clearance}),
        }
    )


@pytest.fixture
def best_first(run_record: RunRecord) -> list[GraspRecord]:
    """Each but the last differs from the next in what decides between them, and is no better in the rest."""
    best = run_record.grasps[0]
    assert best.hold is not None
    six = best.hold.directions
    slipping = [d.model_copy(update={"slip": 4e-3}) for d in six]
    five = [six[0].model_copy(update={"held": False}), *six[1:]]
    return [
        changed(best, "g09", {}, 2e-3),
        changed(best, "g07", {}, 1e-3),
        changed(best, "g08", {}, 1e-3),  # found later
        changed(best, "g06", {"directions": slipping}, 3e-3),
        changed(best, "g11", {"narrow": True}, 3e-3),
        changed(best, "g05", {"held": False, "directions": six}, 3e-3),
        changed(best, "g04", {"held": False, "directions": five}, 3e-3),
        best.model_copy(update={"id": "g03", "hold": None}),
        best.model_copy(update={"id": "g02", "hold": None, "clearance": None}),
        best.model_copy(update={"id": "g10", "hold": None, "clearance": None}),  # by number, not by text
    ]


def test_the_best_come_first_however_they_were_found(best_first: list[GraspRecord]) -> None:
    shuffler = random.Random(0)
    for _ in range(20):
        shuffled = shuffler.sample(best_first, len(best_first))
        assert [g.id for g in sorted(shuffled, key=rank)] == [g.id for g in best_first]
