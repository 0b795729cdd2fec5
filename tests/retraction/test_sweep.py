"""Lines in joint space that are proved clear."""

import numpy as np
import pytest
from holdfast.retraction import RetractionSettings
from holdfast.retraction.distance import measure
from holdfast.retraction.pairs import collision_model
from holdfast.retraction.sweep import sweep
from holdfast.solver import State

SETTINGS = RetractionSettings()


def at(state, q):
    return State(q, state.R_palm_object, state.p_palm_object, state.params)


def required(model):
    return np.where(model.intended, -SETTINGS.contact_depth_m, -SETTINGS.depth_m)


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
