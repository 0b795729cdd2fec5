"""A contact where pieces stand out of the true surface is clear, and nothing beside it is let off."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Patch, shape_mesh
from holdfast.geometry.solids import Closeness
from holdfast.objects import Contact, ObjectModel, ObjectRegion, Part, Task
from holdfast.retraction import (
    ClearConfiguration,
    PairClearance,
    compute_clearance,
    compute_clearance_by_mujoco,
    find_approach,
    retract,
)

from .conftest import box_hull, sample_configurations

DEPTH_M = 0.002


def on_block(task: Task, *, stated_m: float | None) -> Task:
    """The index touches a block whose one piece is higher than its surface by DEPTH_M."""
    surface, piece = (box_hull((-0.02, -0.02, -0.02), (0.02, 0.02, z)) for z in (0.0, DEPTH_M))
    closeness = None if stated_m is None else Closeness(stated_m, 0.0)
    part = Part("block", shape_mesh(surface), (piece,), task.object.inertia, closeness=closeness)
    h = 0.003
    region = ObjectRegion(
        "top", Patch(BezierPatch(np.array([[(-h, -h, 0), (-h, h, 0)], [(h, -h, 0), (h, h, 0)]])))
    )
    model = ObjectModel("block", (part,), 0.6, {"top": region.region})
    return replace(
        task, name="block", object=model, contacts=(Contact(task.hand.regions["index/tip"], region),)
    )


def test_the_pair_of_the_contact_alone_may_sink_in_deeper(task: Task) -> None:
    block = on_block(task, stated_m=DEPTH_M)
    state = sample_configurations(block, 1, seed=2)[0].state
    for table in (compute_clearance(block, state), compute_clearance_by_mujoco(block, state)):
        for pair in table.pairs:
            expected = DEPTH_M if pair.intended else 0.0
            assert pair.allowed_depth_m == pytest.approx(1e-4 + expected, abs=1e-9)
    assert sum(pair.intended for pair in compute_clearance(block, state).pairs) == 1


def test_it_comes_clear_as_far_as_the_remainder_is_stated(task: Task) -> None:
    stated, unstated = on_block(task, stated_m=DEPTH_M), on_block(task, stated_m=None)
    given = sample_configurations(stated, 6, seed=2)
    clear = [outcome for c in given if isinstance(outcome := retract(c), ClearConfiguration)]
    assert clear
    for outcome in clear:
        configuration = outcome.configuration
        pair = compute_clearance(stated, configuration.state)["index_distal", "object/block"]
        assert pair.is_clear and pair.touches
        assert -DEPTH_M - 1e-4 <= pair.distance_m <= -DEPTH_M + 1e-4
        table = compute_clearance(unstated, configuration.state)
        assert not table.is_clear and table.worst is not None and table.worst.intended
        assert find_approach(configuration).reachable


@pytest.mark.parametrize(
    ("distance_m", "touches"), [(-0.0021, True), (-0.0022, False), (0.0, True), (9e-5, True), (2e-4, False)]
)
def test_bodies_that_are_apart_are_no_nearer_for_it(distance_m: float, touches: bool) -> None:
    assert PairClearance("a", "b", distance_m, True, -0.0021, 0.002).touches == touches
