from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import Hull
from holdfast.retraction import (
    Clearance,
    PairClearance,
    RetractionSettings,
    compute_clearance,
    compute_clearances,
)
from holdfast.retraction.clearance import build_clearance, deciding_clearance
from holdfast.retraction.distance import measure
from holdfast.retraction.pairs import collision_model


def shuffled(hull, rng):
    order = rng.permutation(len(hull.vertices))
    renamed = np.argsort(order)
    faces = rng.permutation(renamed[hull.faces])
    return Hull(hull.vertices[order], faces)


def test_numbering_of_pieces_changes_nothing(task, configurations):
    rng = np.random.default_rng(3)
    links = tuple(replace(link, shapes=link.shapes[::-1]) for link in task.hand.links)
    parts = tuple(
        replace(part, pieces=tuple(shuffled(piece, rng) for piece in part.pieces))
        for part in task.object.parts[::-1]
    )
    other = replace(task, hand=replace(task.hand, links=links), object=replace(task.object, parts=parts))
    for configuration in configurations[:10]:
        before = compute_clearance(task, configuration.state)
        after = compute_clearance(other, configuration.state)
        assert before.is_clear == after.is_clear
        assert before.worst is not None and after.worst is not None
        assert (before.worst.a, before.worst.b) == (after.worst.a, after.worst.b)
        for pair in before.pairs:
            assert after[pair.a, pair.b].distance_m == pytest.approx(pair.distance_m, abs=1e-8, rel=1e-5)
            assert after[pair.b, pair.a].intended == pair.intended


def test_contacts_are_neither_deep_nor_open(configurations):
    for configuration in configurations:
        table = compute_clearance(configuration.task, configuration.state)
        for link in ("index_distal", "thumb_distal"):
            assert table[link, "object/handle"].distance_m < 1e-4


def test_many_states_are_each_as_alone(task, configurations):
    states = [configuration.state for configuration in configurations[:3]]
    assert compute_clearances(task, states) == [compute_clearance(task, state) for state in states]


def pair(distance, intended=False, required=-1e-4):
    return PairClearance("a", "b", distance, intended, required)


def test_worst_pair_sets_good_contacts_aside():
    table = Clearance((pair(-5e-5, intended=True), pair(0.003), pair(0.01)))
    assert table.is_clear
    assert table.least_m == 0.003
    sunk = Clearance((pair(-2e-4, intended=True), pair(0.003)))
    assert not sunk.is_clear
    assert sunk.least_m == -2e-4
    assert Clearance((pair(0.0, intended=True),)).worst is None


def test_where_nothing_is_in_the_way_the_distance_is_a_number():
    """As of a gripper of one jaw that holds something: records and tables hold no infinity."""
    assert Clearance((pair(0.0, intended=True),)).least_m == Clearance(()).least_m == 1.0


def test_margin_is_asked_of_pairs_that_should_not_touch(task, clear):
    wide = RetractionSettings(margin_m=0.05)
    table = compute_clearance(task, clear[0].state, settings=wide)
    assert not table.is_clear
    assert table["index_distal", "object/handle"].is_clear
    assert table["palm", "thumb_distal"].allowed_depth_m == -0.05


def test_unknown_pair(task, clear):
    with pytest.raises(KeyError):
        compute_clearance(task, clear[0].state)["palm", "index_proximal"]


@pytest.mark.parametrize("margin_m", [0.0, 0.004])
def test_what_is_left_unmeasured_changes_nothing(task, configurations, colliding, margin_m):
    """Against all pieces measured: the same distances, and of what decides the same pairs."""
    settings, model = RetractionSettings(margin_m=margin_m), collision_model(task)
    for configuration in (*configurations[:4], *colliding[:4]):
        everything = measure(model.place(configuration.state), model.piece_pairs).distance_m
        whole = build_clearance(model, everything, settings)
        assert compute_clearance(task, configuration.state, settings=settings) == whole
        deciding = deciding_clearance(task, configuration.state, settings=settings)
        assert deciding.worst == whole.worst and len(deciding.pairs) < len(whole.pairs)
        obstacles = [[pair for pair in table.pairs if not pair.is_clear] for table in (deciding, whole)]
        assert obstacles[0] == obstacles[1]
