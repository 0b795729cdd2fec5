import numpy as np
import pytest
from holdfast.retraction.qp import build_step, coordinate_scale, solve_step

TRUST = 0.01


@pytest.fixture
def state(configurations):
    return configurations[0].state


def test_step_keeps_contacts_limits_and_trust(manifold, state):
    scale = coordinate_scale(manifold)
    rng = np.random.default_rng(0)
    J = rng.normal(size=(12, manifold.n_tangent)) * scale
    room = rng.uniform(-0.005, 0.02, 12)
    dx = solve_step(build_step(manifold, state, scale, J, room, TRUST))
    assert dx is not None
    c, J_contact = manifold.linearise(state)
    np.testing.assert_allclose(J_contact @ dx, -c, atol=1e-6 * TRUST)
    assert np.abs(dx * scale).max() <= TRUST * (1 + 1e-6)
    x = np.concatenate([state.q, state.params]) + dx[manifold.bounded]
    assert np.all(x >= manifold.lower - 1e-6) and np.all(x <= manifold.upper + 1e-6)
    # Pairs that are clear stay so, to first order; what is deep becomes less so.
    after = room + J @ dx
    assert np.all(after[room >= 0.0] >= -1e-6)
    assert after[room < 0.0].sum() > room[room < 0.0].sum()


def test_nothing_to_do_means_no_step(manifold, state):
    nothing = np.zeros((0, manifold.n_tangent)), np.zeros(0)
    dx = solve_step(build_step(manifold, state, coordinate_scale(manifold), *nothing, TRUST))
    assert dx is not None
    assert np.abs(dx).max() < 1e-6


def test_coordinates_are_measured_in_metres(manifold):
    scale = coordinate_scale(manifold)
    assert scale.shape == (manifold.n_tangent,)
    assert np.all(scale > 0.0)
    np.testing.assert_array_equal(scale[manifold.n_q : manifold.n_q + 3], 1.0)
