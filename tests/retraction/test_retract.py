from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import PointRegion
from holdfast.retraction import (
    ClearConfiguration,
    FailureReason,
    RetractionFailure,
    RetractionSettings,
    RetractionStatus,
    Route,
    compute_clearance,
    compute_clearance_by_mujoco,
    retract,
)
from holdfast.retraction.descent import PenetrationProblem
from holdfast.retraction.jacobian import distance_jacobian
from holdfast.retraction.pairs import collision_model
from holdfast.solver import Configuration, ContactManifold, State
from holdfast.solver.contacts.distance import distance
from holdfast.solver.contacts.local_search import search_locally


@pytest.fixture(scope="module")
def outcomes(colliding):
    return [retract(configuration) for configuration in colliding]


def pushed_into_collision(manifold, state):
    """Steps along the contacts that drive the nearest bodies into each other, to a depth of 4 mm."""
    problem = PenetrationProblem(collision_model(manifold.task), manifold, RetractionSettings())
    apart = ~problem.model.intended
    for _ in range(60):
        point = problem.point(state)
        if point.worst_m > 0.004:
            return state
        near, gaps = point.near(0.05)
        J = distance_jacobian(manifold, problem.model, state, gaps)
        nearest = np.argmin(np.where(apart[near], gaps.distance_m, np.inf))
        c, J_contact = manifold.linearise(state)
        null = np.linalg.svd(J_contact / problem.scale)[2][len(c) :]
        downhill = -null.T @ (null @ (J[nearest] / problem.scale))
        following = manifold.project(manifold.retract(state, 0.002 * downhill / problem.scale))
        if following is None or not manifold.is_feasible(following):
            return None
        state = following
    return None


def test_samples_hold_both_kinds(clear, colliding):
    assert len(clear) >= 5
    assert len(colliding) >= 8


def test_clear_configurations_are_returned_unchanged(clear):
    for configuration in clear:
        outcome = retract(configuration)
        assert isinstance(outcome, ClearConfiguration)
        assert outcome.configuration is configuration
        assert outcome.status is RetractionStatus.CLEAR
        assert outcome.before_m == outcome.after_m
        assert outcome.steps == outcome.restarts == 0


@pytest.fixture(scope="module")
def cleared(outcomes):
    """Nearly all of the colliding configurations, which are eight at least."""
    found = [outcome for outcome in outcomes if isinstance(outcome, ClearConfiguration)]
    assert len(found) >= 0.95 * len(outcomes) and len(outcomes) >= 8
    return found


def test_colliding_configurations_are_cleared(cleared):
    for outcome in cleared:
        assert outcome.status is RetractionStatus.RETRACTED
        assert outcome.before_m < -1e-4
        assert outcome.after_m >= 0.0


def test_contacts_limits_and_caps_hold_afterwards(cleared, manifold):
    for outcome in cleared:
        state = outcome.configuration.state
        assert np.abs(manifold.residual(state)).max() <= 1e-9
        assert manifold.is_feasible(state)
        limits = manifold.task.limits
        assert np.all(state.q >= limits[:, 0] - 1e-9)
        assert np.all(state.q <= limits[:, 1] + 1e-9)


def test_certificates_are_kept(outcomes, colliding):
    kept = [
        outcome.configuration.certified
        for before, outcome in zip(colliding, outcomes, strict=True)
        if before.certified and isinstance(outcome, ClearConfiguration)
    ]
    assert len(kept) >= 8 and all(kept)


def test_mujoco_finds_no_penetration_either(cleared):
    for outcome in cleared:
        configuration = outcome.configuration
        table = compute_clearance_by_mujoco(configuration.task, configuration.state)
        assert table.is_clear
        assert table.least_m == pytest.approx(outcome.after_m, abs=1e-6)
        assert table.worst is not None
        assert (table.worst.a, table.worst.b) == outcome.worst_pair


def test_planted_grasp_comes_back_free(clear, manifold):
    planted = 0
    for configuration in clear:
        state = pushed_into_collision(manifold, configuration.state)
        if state is None:
            continue
        planted += 1
        start = Configuration(manifold.task, state, 0.0, None)
        outcome = retract(start)
        assert isinstance(outcome, ClearConfiguration)
        assert outcome.before_m < -0.003
        assert outcome.after_m >= 0.0
    assert planted >= 3


def test_outcome_does_not_depend_on_the_others(colliding, outcomes):
    again = retract(colliding[-1])
    assert again.status == outcomes[-1].status
    assert again.after_m == outcomes[-1].after_m
    assert again.steps == outcomes[-1].steps


def test_margin_is_kept(clear, manifold):
    settings = RetractionSettings(margin_m=0.004)
    for configuration in clear[:5]:
        outcome = retract(configuration, settings=settings)
        assert isinstance(outcome, ClearConfiguration)
        assert outcome.after_m >= 0.004
        table = compute_clearance(manifold.task, outcome.configuration.state)
        assert all(pair.distance_m >= 0.004 for pair in table.pairs if not pair.intended)


def test_impossible_contact_names_what_blocks(slot_task):
    manifold = ContactManifold(slot_task)
    q = 0.5 * manifold.task.limits.sum(axis=1)
    start = State(q, np.diag([1.0, -1.0, -1.0]), np.array([0.1, 0.0, 0.15]), np.full(2, 0.5))
    state = search_locally(manifold, start)
    assert state is not None
    configuration = Configuration(slot_task, state, 0.0, None)
    outcome = retract(configuration, settings=RetractionSettings(restarts=3))
    assert isinstance(outcome, RetractionFailure)
    assert (outcome.status, outcome.reason) == (RetractionStatus.FAILED, FailureReason.BLOCKED)
    assert outcome.configuration is configuration
    assert outcome.worst_pair is not None
    assert set(outcome.worst_pair) & {"object/left", "object/right"}
    # A ball of 13 mm that touches the floor of a slot of half width 5 mm is some 8 mm deep in a wall.
    assert outcome.before_m - 1e-9 <= outcome.after_m < -0.005
    assert "mm deep" in str(outcome) and outcome.worst_pair[1] in str(outcome)
    assert np.abs(manifold.residual(outcome.state)).max() <= 1e-9


def test_route_says_how_far_from_the_given_configuration(colliding, outcomes):
    routes = set()
    for before, outcome in zip(colliding, outcomes, strict=True):
        if not isinstance(outcome, ClearConfiguration):
            continue
        routes.add(outcome.route)
        assert outcome.moved == distance(before.state, outcome.configuration.state) > 0.0
        # The first two descents start from the given contacts where there are free joints out of rest.
        assert (outcome.route is Route.SLID) == (outcome.restarts <= 1)
    assert {Route.SLID} < routes


def on_table(configuration, depth_m):
    """The same where the object stands on a table that reaches `depth_m` into the lowest link."""
    task, state = configuration.task, configuration.state
    model = collision_model(task)
    placed = model.place(state)
    up = np.array([0.0, 0.0, 1.0])
    of_hand = [i for i, b in enumerate(model.bodies.piece_body) if b < len(task.hand.links)]
    lowest = min(placed.core(i)[:, 2].min() - model.bodies.radius[i] for i in of_hand)
    top = state.R_palm_object.T @ ((lowest + depth_m) * up - state.p_palm_object)
    table = replace(task, support=PointRegion(top, state.R_palm_object.T @ up))
    return Configuration(table, state, configuration.residual_m, None)


def test_hand_is_moved_out_of_the_support(clear):
    lifted = 0
    for configuration in clear[:4]:
        standing = on_table(configuration, 0.003)
        outcome = retract(standing)
        assert outcome.before_m == pytest.approx(-0.003, abs=1e-6)
        if isinstance(outcome, ClearConfiguration):
            lifted += 1
            end = outcome.configuration
            for measured in (compute_clearance, compute_clearance_by_mujoco):
                pairs = measured(end.task, end.state).pairs
                assert min(pair.distance_m for pair in pairs if pair.b == "support") >= -1e-6
    assert lifted >= 3


def test_support_that_nothing_avoids_is_named(clear):
    # Neither the hand nor the object, with its table, can give way.
    standing = on_table(clear[0], 0.01)
    q, T_palm_object = standing.state.q, standing.state.T_palm_object
    stiff = replace(standing.task, limits=np.column_stack([q, q]), T_palm_object=T_palm_object)
    configuration = Configuration(stiff, standing.state, 0.0, None)
    outcome = retract(configuration, settings=RetractionSettings(restarts=2))
    assert isinstance(outcome, RetractionFailure)
    assert outcome.worst_pair is not None and outcome.worst_pair[1] == "support"
    assert outcome.after_m == pytest.approx(-0.01, abs=1e-6)
    assert set(stiff.hand.independent_names) <= set(outcome.active_limits)
