"""Which grasp of a run comes first."""

import random

import pytest
from holdfast.pipeline.records import GraspRecord, RunRecord
from holdfast.pipeline.run import ranking
from holdfast.pipeline.run.ranking import in_order, rank, with_grasp


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
    best = changed(run_record.grasps[0], "g01", {"strain": 0.5}, 1e-3)
    assert best.hold is not None
    six = best.hold.directions
    slipping = [d.model_copy(update={"slip": 4e-3}) for d in six]
    five = [six[0].model_copy(update={"held": False}), *six[1:]]
    return [
        changed(best, "g12", {"strain": 0.2, "directions": slipping}, 1e-3),
        changed(best, "g13", {"strain": 0.4}, 2e-3),
        changed(best, "g09", {}, 2e-3),
        changed(best, "g07", {}, 1e-3),
        changed(best, "g08", {}, 1e-3),  # found later
        changed(best, "g06", {"directions": slipping}, 3e-3),
        changed(best, "g15", {"strain": None}, 3e-3),
        changed(best, "g11", {"narrow": True}, 3e-3),
        changed(best, "g14", {"held": False, "directions": five, "near_miss": True}, 2e-3),
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


def test_one_after_the_other_they_stand_as_if_sorted(
    best_first: list[GraspRecord], run_record: RunRecord, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In any order of verdicts; motions stay with those that are shown, and only with them."""
    monkeypatch.setattr(ranking, "MOST_SHOWN", 3)
    found = [grasp.model_copy(update={"hold": None, "clearance": None}) for grasp in best_first]
    expected = in_order(run_record.model_copy(update={"grasps": best_first}))
    assert [grasp.id for grasp in expected.grasps] == [grasp.id for grasp in best_first]
    assert [g.has_motion for g in expected.grasps] == [k < 3 for k in range(len(best_first))]
    shuffler = random.Random(1)
    for _ in range(20):
        record = in_order(run_record.model_copy(update={"grasps": found}))
        for grasp in shuffler.sample(best_first, len(best_first)):
            record = with_grasp(record, grasp)
        assert record == expected
    whole, bare = best_first[4], expected.grasps[4]
    assert bare.hold is not None and bare.hold.margin == (whole.hold and whole.hold.margin)
    assert bare.with_motion_of(whole) == whole and bare.without_motion() is bare
