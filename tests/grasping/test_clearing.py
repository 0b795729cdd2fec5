"""Clearing and strengthening: what is clear stays so on the way up, and no balance is given away unseen."""

import numpy as np
import pytest
from holdfast.grasping import strengthen_and_clear
from holdfast.mjcf import preset_settings, start_strengths, strengthen
from holdfast.objects import load_task
from holdfast.retraction import (
    ClearConfiguration,
    ClearRoom,
    RetractionSettings,
    RetractionStatus,
    compute_clearance,
    compute_clearance_by_mujoco,
    retract,
)
from holdfast.solver import Configuration, ContactManifold, solve

TASK = load_task("service")
SETTINGS = preset_settings("holdfast", TASK)
CLEAR = RetractionSettings()


@pytest.fixture(scope="module")
def cleared() -> list[Configuration]:
    """Configurations made clear, without a thought of what they carry."""
    outcomes = [retract(c) for c in solve(TASK, candidates=4, seed=0).configurations]
    return [outcome.configuration for outcome in outcomes if isinstance(outcome, ClearConfiguration)]


def test_a_climb_that_keeps_clear_ends_clear_and_higher(cleared: list[Configuration]) -> None:
    reached = [strengthen(c, settings=SETTINGS, keep_clear=CLEAR) for c in cleared]
    before = start_strengths(cleared, settings=SETTINGS)
    after = start_strengths(reached, settings=SETTINGS)
    assert np.all(after >= before - 1e-3) and np.any(after > before + 0.5)
    for configuration in reached:
        assert configuration.certified and ContactManifold(TASK).is_feasible(configuration.state)
        assert compute_clearance(TASK, configuration.state).is_clear
        # By a library that the climb does not use.
        table = compute_clearance_by_mujoco(TASK, configuration.state)
        assert all(pair.distance_m > -1.1e-4 for pair in table.pairs)


def test_room_is_what_retraction_counts_as_clear(cleared: list[Configuration]) -> None:
    room = ClearRoom(ContactManifold(TASK), CLEAR)
    assert all(room.is_clear(c.state) for c in cleared)
    solved = solve(TASK, candidates=8, seed=1).configurations
    for configuration in solved:
        assert room.is_clear(configuration.state) == compute_clearance(TASK, configuration.state).is_clear
    assert not all(room.is_clear(c.state) for c in solved)


def test_rows_bound_how_much_nearer_bodies_come(cleared: list[Configuration]) -> None:
    """No pair comes nearer, by first order, than the rows that are in force say."""
    manifold = ContactManifold(TASK)
    room = ClearRoom(manifold, CLEAR)
    rng = np.random.default_rng(0)
    for configuration in cleared:
        J, least_m = room.rows(configuration.state, 0.02)
        # Where next to no room is left, a little is to be made.
        assert J.shape == (len(least_m), manifold.n_tangent) and np.all(least_m <= 2e-5)
        dx = 1e-5 * rng.normal(size=manifold.n_tangent)
        # Nearest pairs by `compute_clearance` before and after a small step.
        before = {(p.a, p.b): p.distance_m for p in compute_clearance(TASK, configuration.state).pairs}
        moved = compute_clearance(TASK, manifold.retract(configuration.state, dx)).pairs
        changes = [p.distance_m - before[p.a, p.b] for p in moved if before[p.a, p.b] < 0.015]
        assert min(changes) >= float((J @ dx).min()) - 2e-7
        assert max(changes) <= float((J @ dx).max()) + 2e-7


def test_of_all_turns_the_strongest_counts_and_the_record_says_what_it_carries() -> None:
    for configuration in solve(TASK, candidates=2, seed=3).configurations:
        clearing = strengthen_and_clear(configuration, settings=SETTINGS)
        assert clearing.is_clear and clearing.strengths is not None
        _, after = clearing.strengths
        now = float(start_strengths([clearing.configuration], settings=SETTINGS)[0])
        assert after == pytest.approx(now, abs=1e-4)
        ends = [one.configuration for one in clearing.outcomes if one.status is not RetractionStatus.FAILED]
        assert now >= start_strengths(ends, settings=SETTINGS).max() - 1e-4
