"""Lines in joint space that are proved clear."""

import numpy as np
import pytest
from holdfast.retraction import RetractionSettings
from holdfast.retraction.distance import measure
from holdfast.retraction.pairs import collision_model
from holdfast.retraction.sweep import _Line, lowest_between, sweep
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


def test_the_least_between_two_ends_is_that_of_the_sharpest_bend():
    """A parabola with that second derivative reaches it, and none that bends less goes below."""
    rng = np.random.default_rng(7)
    start, end = rng.uniform(-1.0, 1.0, (2, 200))
    bend = rng.uniform(0.0, 6.0, 200)
    shares = np.linspace(0.0, 1.0, 2001)[:, None]
    parabolas = start + shares * (end - start) - 0.5 * bend * shares * (1.0 - shares)
    assert lowest_between(start, end, bend) == pytest.approx(parabolas.min(axis=0), abs=1e-6)
    assert np.all(lowest_between(start, end, 0.0 * bend) == np.minimum(start, end))
    assert np.all(lowest_between(start, end, np.full(200, np.inf)) == -np.inf)


def test_no_two_points_bend_more_along_a_direction_than_the_bound(task, configurations):
    model = collision_model(task)
    rng = np.random.default_rng(5)
    bodies, a, b = model.bodies, *model.piece_pairs.T
    largest = 0.0
    for configuration in configurations:
        state = configuration.state
        q = np.clip(state.q + rng.normal(scale=0.3, size=len(state.q)), *task.limits.T)
        line = _Line(model, state, q, required(model))
        for share in (0.1, 0.5, 0.9):
            step = 1e-3
            before, here, after = (line.place(share + k * step).vertices for k in (-1, 0, 1))
            second = (before - 2.0 * here + after) / step**2
            for normal in np.eye(3):
                along = second @ normal
                high = np.maximum.reduceat(along, bodies.starts[:-1])
                low = np.minimum.reduceat(along, bodies.starts[:-1])
                bend = np.maximum(high[b] - low[a], high[a] - low[b])
                assert np.all(bend <= line.bend_m * (1.0 + 1e-3) + 1e-6)
                bounded = np.isfinite(line.bend_m) & (line.bend_m > 1e-6)
                largest = max(largest, (bend[bounded] / line.bend_m[bounded]).max(initial=0.0))
    assert largest > 0.02  # the bound is not idle


def test_pairs_that_slide_along_their_limit_take_few_steps(task, clear, monkeypatch):
    """The limit of each pair is what it comes down to on the way, to a micrometre."""
    model = collision_model(task)
    rng = np.random.default_rng(6)
    places = []
    place = _Line.place
    monkeypatch.setattr(_Line, "place", lambda self, share: places.append(share) or place(self, share))
    state = clear[0].state
    q = np.clip(state.q + rng.normal(scale=0.02, size=len(state.q)), *task.limits.T)
    line = _Line(model, state, q, required(model))
    least = np.min(
        [measure(place(line, share), model.piece_pairs).distance_m for share in np.linspace(0.0, 1.0, 101)],
        axis=0,
    )
    limit = np.where(np.isfinite(line.bend_m), least - 1e-6, -1.0)
    assert sweep(model, state, q, limit) is None
    assert len(places) < 400
