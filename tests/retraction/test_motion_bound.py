"""How far bodies get when joints move: no distance changes by more than its bound."""

import numpy as np
import pytest
from holdfast.retraction.distance import measure
from holdfast.retraction.motion_bound import motion_bounds
from holdfast.retraction.pairs import collision_model
from holdfast.solver import State


def at(state, q):
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


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
