"""How far states are apart, against quaternions of another library, and which count as distinct."""

import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Task
from holdfast.solver import State, solve
from holdfast.solver.contacts.distance import DistinctStates, distance
from scipy.spatial.transform import Rotation

from .written_out import SHIFT_M, distance_written_out, distances_written_out


def random_state(rng: np.random.Generator, n_joints: int) -> State:
    turn = rotation_exp(0.4 * rng.normal(size=3))
    return State(rng.uniform(-0.4, 0.4, n_joints), turn, 0.4 * SHIFT_M * rng.normal(size=3), np.zeros(0))


@pytest.mark.parametrize("n_joints", [0, 1, 4])
def test_the_distance_is_the_largest_of_three(n_joints: int) -> None:
    rng = np.random.default_rng(n_joints)
    for _ in range(50):
        a, b = random_state(rng, n_joints), random_state(rng, n_joints)
        assert distance(a, b) == pytest.approx(distance_written_out(a, b), rel=1e-9)
        assert distance(b, a) == pytest.approx(distance(a, b), rel=1e-12)


def test_distances_of_joints_turns_and_shifts_by_hand() -> None:
    still = State(np.zeros(2), np.eye(3), np.zeros(3), np.zeros(0))
    assert distance(still, still) == 0.0
    bent = State(np.array([0.1, -0.3]), np.eye(3), np.zeros(3), np.zeros(0))
    shifted = State(np.zeros(2), np.eye(3), np.array([0.0, 0.03, 0.04]), np.zeros(0))
    turned = State(
        np.zeros(2), Rotation.from_euler("y", 170, degrees=True).as_matrix(), np.zeros(3), np.zeros(0)
    )
    assert distance(still, bent) == pytest.approx(0.3)
    assert distance(still, shifted) == pytest.approx(0.5)
    assert distance(still, turned) == pytest.approx(np.deg2rad(170))


@pytest.mark.parametrize("n_joints", [0, 1, 4])
@pytest.mark.parametrize("least", [0.1, 0.5, 1.0])
def test_a_state_is_kept_where_no_other_is_near(n_joints: int, least: float) -> None:
    rng = np.random.default_rng(n_joints)
    distinct, kept = DistinctStates(least), list[State]()
    for _ in range(300):
        state = random_state(rng, n_joints)
        is_new = bool(np.all(distances_written_out(state, kept) >= least))
        assert distinct.add(state) is is_new
        kept += [state] * is_new
    assert len(kept) > 1


@pytest.mark.parametrize("angle", [0.099, 0.101, 1.5, 3.1])
def test_turns_alone_tell_states_apart(angle: float) -> None:
    distinct = DistinctStates(0.1)
    q, p = np.zeros(2), np.zeros(3)
    assert distinct.add(State(q, np.eye(3), p, p))
    axis = np.array([0.6, 0.0, 0.8])
    assert distinct.add(State(q, rotation_exp(angle * axis), p, p)) is (angle >= 0.1)


def test_parameters_do_not_count() -> None:
    distinct = DistinctStates(0.1)
    assert distinct.add(State(np.zeros(2), np.eye(3), np.zeros(3), np.zeros(2)))
    assert not distinct.add(State(np.zeros(2), np.eye(3), np.zeros(3), np.ones(2)))


@pytest.mark.parametrize("count", [40, pytest.param(300, marks=pytest.mark.slow)])
def test_many_configurations_are_certified_and_distinct(count: int, upholding: Task) -> None:
    found = solve(upholding, candidates=count, seed=7).configurations
    assert len(found) == count
    for i, one in enumerate(found):
        assert one.certificate is not None
        assert one.residual_m < 1e-12
        assert np.all(distances_written_out(one.state, [other.state for other in found[:i]]) >= 0.1)
