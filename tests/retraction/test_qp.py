import numpy as np
import pytest
from holdfast.retraction.pairs import collision_model
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


def test_coordinates_are_measured_by_the_motion_that_they_cause(task, manifold, state):
    """A step of 1 mm in any coordinate moves something by about as much, and nothing by much more."""
    scale = coordinate_scale(manifold)
    model = collision_model(task)

    def places(state):
        contacts = manifold.contact_points(state)
        return np.vstack([model.place(state).vertices, *([c.p_hand, c.p_object] for c in contacts)])

    here = places(state)
    moved = []
    for i in range(manifold.n_tangent):
        dx = np.zeros(manifold.n_tangent)
        dx[i] = 1e-3 / scale[i]
        ends = [places(manifold.retract(state, sign * dx)) for sign in (1.0, -1.0)]
        # Limits may stop the motion one way.
        moved.append(max(np.linalg.norm(end - here, axis=1).max() for end in ends) / 1e-3)
    assert min(moved) > 0.2 and max(moved) < 5.0
