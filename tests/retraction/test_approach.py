"""The approach: pregrasp, and the way from there proved clear; motion bounds and sweeps by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import PointRegion
from holdfast.retraction import (
    ClearConfiguration,
    RetractionSettings,
    compute_clearance,
    compute_clearance_by_mujoco,
    find_approach,
    retract,
)
from holdfast.retraction.distance import measure
from holdfast.retraction.motion_bound import motion_bounds
from holdfast.retraction.pairs import collision_model
from holdfast.retraction.sweep import sweep
from holdfast.solver import Configuration, ContactManifold, State

SETTINGS = RetractionSettings()


def at(state, q):
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


def required(model):
    return np.where(model.intended, -SETTINGS.contact_depth_m, -SETTINGS.depth_m)


@pytest.fixture(scope="module")
def grasps(colliding):
    outcomes = [retract(configuration) for configuration in colliding[:6]]
    return [o.configuration for o in outcomes if isinstance(o, ClearConfiguration)]


def test_distances_change_by_no_more_than_the_bound(task, configurations):
    model, bounds = collision_model(task), motion_bounds(task)
    rng = np.random.default_rng(2)
    for configuration in configurations[:6]:
        state = configuration.state
        q = rng.uniform(*task.limits.T)
        here, there = (measure(model.place(s), model.piece_pairs) for s in (state, at(state, q)))
        change = np.abs(here.distance_m - there.distance_m)
        travel = bounds @ np.abs(task.hand.coupling_matrix @ (q - state.q))
        assert np.all(change <= travel + 1e-8)
    # The bound is of use: some joint is charged with no more than the hand's own length.
    assert 0.05 < bounds.max() < 1.0


def test_joints_that_carry_both_bodies_do_not_count(task):
    model, bounds = collision_model(task), motion_bounds(task)
    names = task.hand.joint_names
    for k, (a, b) in enumerate(model.piece_pairs):
        links = [model.bodies.bodies[model.bodies.piece_body[i]].name for i in (a, b)]
        if links == ["thumb_base", "thumb_medial"]:
            assert bounds[k, names.index("thumb_base")] == 0.0
            assert bounds[k, names.index("thumb_flexion")] > 0.0
            break
    else:
        pytest.fail("the pair is not watched")


def test_sweep_agrees_with_a_fine_sampling(task, configurations):
    model = collision_model(task)
    rng = np.random.default_rng(4)
    clear = blocked = 0
    for configuration in configurations:
        state = configuration.state
        # Short lines from clear states, so that both answers come up.
        if np.any(measure(model.place(state), model.piece_pairs).distance_m < required(model)):
            continue
        q = np.clip(state.q + rng.normal(scale=0.15, size=len(state.q)), *task.limits.T)
        found = sweep(model, state, q, required(model))
        shares = np.linspace(0.0, 1.0, 60)
        rooms = [
            (measure(model.place(at(state, state.q + s * (q - state.q))), model.piece_pairs).distance_m)
            - required(model)
            for s in shares
        ]
        if found is None:
            clear += 1
            assert min(room.min() for room in rooms) >= -1e-9
        else:
            blocked += 1
            there = at(state, state.q + found.share * (q - state.q))
            distance = measure(model.place(there), model.piece_pairs[[found.pair]]).distance_m[0]
            assert distance == pytest.approx(found.distance_m, abs=1e-12)
            assert distance < required(model)[found.pair] + 1e-7
    assert clear >= 1 and blocked >= 1


def test_sweep_finds_what_its_ends_do_not_show(task, clear):
    # A joint goes from where nothing collides through something to where nothing collides again.
    model = collision_model(task)
    found = 0
    for configuration in clear:
        state = configuration.state
        for i, end in ((k, limit) for k in range(len(state.q)) for limit in task.limits[k]):
            q = state.q.copy()
            q[i] = end
            rooms = [
                measure(model.place(at(state, x)), model.piece_pairs).distance_m - required(model)
                for x in (state.q, q)
            ]
            middle = measure(model.place(at(state, 0.5 * (q + state.q))), model.piece_pairs).distance_m
            if all(room.min() >= 0.0 for room in rooms) and (middle - required(model)).min() < 0.0:
                found += 1
                assert sweep(model, state, q, required(model)) is not None
    assert found >= 1
    # A line that leads nowhere is clear where it starts.
    assert sweep(model, clear[0].state, clear[0].state.q, required(model)) is None


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
