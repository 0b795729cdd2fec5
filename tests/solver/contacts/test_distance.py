"""Which states count as distinct, against `distance` itself."""

import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_exp
from holdfast.objects import Task
from holdfast.solver import State, solve
from holdfast.solver.contacts.distance import SHIFT_M, DistinctStates, distance


def random_state(rng: np.random.Generator, n_joints: int) -> State:
    turn = rotation_exp(0.4 * rng.normal(size=3))
    return State(rng.uniform(-0.4, 0.4, n_joints), turn, 0.4 * SHIFT_M * rng.normal(size=3), np.zeros(0))


@pytest.mark.parametrize("n_joints", [0, 1, 4])
@pytest.mark.parametrize("least", [0.1, 0.5, 1.0])
def test_a_state_is_kept_where_no_other_is_near(n_joints: int, least: float) -> None:
    rng = np.random.default_rng(n_joints)
    distinct, kept = DistinctStates(least), list[State]()
    for _ in range(300):
        state = random_state(rng, n_joints)
        is_new = all(distance(state, other) >= least for other in kept)
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


def test_hundreds_of_configurations_are_certified_and_distinct(upholding: Task) -> None:
    found = solve(upholding, candidates=300, seed=7).configurations
    assert len(found) == 300
    for i, one in enumerate(found):
        assert one.certificate is not None
        assert one.residual_m < 1e-12
        assert all(distance(one.state, other.state) >= 0.1 for other in found[:i])
