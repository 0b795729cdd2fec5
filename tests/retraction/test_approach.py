"""The approach: pregrasp, and the way from there proved clear; motion bounds and sweeps by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import PointRegion
from holdfast.retraction import (
    ClearConfiguration,
    compute_clearance,
    compute_clearance_by_mujoco,
    find_approach,
    retract,
)
from holdfast.retraction.pairs import collision_model
from holdfast.solver import Configuration, ContactManifold, State


def at(state, q):
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


@pytest.fixture(scope="module")
def grasps(colliding):
    outcomes = [retract(configuration) for configuration in colliding[:6]]
    return [o.configuration for o in outcomes if isinstance(o, ClearConfiguration)]


def test_pregrasp_is_open_and_the_way_is_clear(task, grasps):
    reached = 0
    for configuration in grasps:
        approach = find_approach(configuration)
        assert np.array_equal(approach.waypoints[-1], configuration.state.q)
        assert np.all(approach.waypoints >= task.limits[:, 0] - 1e-12)
        assert np.all(approach.waypoints <= task.limits[:, 1] + 1e-12)
        if not approach.reachable:
            assert approach.opening_m < 0.010
            assert str(approach).startswith("unreachable")
            continue
        reached += 1
        assert approach.opening_m >= 0.010
        open_state = at(configuration.state, approach.pregrasp)
        for clearance in (compute_clearance, compute_clearance_by_mujoco):
            table = clearance(task, open_state)
            assert table.is_clear
            # The fingertips, which have come away from the handle by so much along its normals.
            for link in ("index_distal", "thumb_distal"):
                assert table[link, "object/handle"].distance_m > 0.005
        for start, end in zip(approach.waypoints[:-1], approach.waypoints[1:], strict=True):
            for share in np.linspace(0.0, 1.0, 7):
                between = at(configuration.state, start + share * (end - start))
                assert compute_clearance(task, between).is_clear
    assert reached >= 1


def test_fingers_that_can_not_open_are_told(task, grasps):
    # With every joint held where it is there is no way to open.
    configuration = grasps[0]
    q = configuration.state.q
    stiff = replace(task, limits=np.column_stack([q, q]))
    approach = find_approach(Configuration(stiff, configuration.state, 0.0, None))
    assert not approach.reachable
    assert approach.opening_m == pytest.approx(0.0, abs=1e-12)
    assert np.array_equal(approach.pregrasp, q)


def test_hand_keeps_above_the_support(task, grasps):
    # A table through the middle of the hand: every link is measured against it, by both libraries alike.
    state = grasps[0].state
    R, p = state.R_palm_object, state.p_palm_object
    n_palm = np.array([0.0, 0.0, 1.0])
    for height in (-0.2, 0.08):
        top = R.T @ (np.array([0.0, 0.0, height]) - p)
        on_table = replace(task, support=PointRegion(top, R.T @ n_palm))
        ours = compute_clearance(on_table, state)
        theirs = compute_clearance_by_mujoco(on_table, state)
        lowest = collision_model(task).place(state)
        for link in task.hand.links:
            body = [b.name for b in lowest.bodies.bodies].index(link.name)
            pieces = np.flatnonzero(lowest.bodies.piece_body == body)
            z = min((lowest.core(i)[:, 2]).min() - lowest.bodies.radius[i] for i in pieces)
            pair = ours[link.name, "support"]
            assert not pair.intended
            if z - height > -0.05:  # deeper, the shortest way out need not be up
                assert pair.distance_m == pytest.approx(z - height, abs=1e-6)
            assert theirs[link.name, "support"].distance_m == pytest.approx(
                pair.distance_m, abs=1e-6, rel=1e-3
            )
    assert ContactManifold(on_table).n_tangent == ContactManifold(task).n_tangent
