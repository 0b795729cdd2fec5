"""What contacts have to spare: its slope is that of its value, its sign says what is carried, it scales."""

from dataclasses import replace
from functools import cache

import holdfast.solver
import numpy as np
import pytest
from holdfast.geometry import rotation_exp
from holdfast.mjcf import HoldSettings, planned_slack, preset_settings, strengthen
from holdfast.mjcf.squeeze.climbing.grasp_slack import SlackMeasure
from holdfast.mjcf.squeeze.climbing.grasp_strength import StrengthMeasure
from holdfast.objects import load_task
from holdfast.solver import Configuration, ContactManifold, State

# Weightless in the squeeze, resting on a palm that carries over an area, near the servos' limits.
TASKS = ("upholding", "transportation", "holding")


@cache
def case(name: str) -> tuple[HoldSettings, tuple[Configuration, Configuration]]:
    """Settings of a task's test, and a configuration as solved and as strengthened."""
    task = load_task(name)
    settings = preset_settings("holdfast", task)
    solved = holdfast.solver.solve(task, candidates=1, seed=3).configurations[0]
    return settings, (solved, strengthen(replace(solved, certificate=None), settings=settings))


def displaced(manifold: ContactManifold, state: State, dx: np.ndarray) -> State:
    """The state that a tangent step leads to, limits or not: a derivative must not see them."""
    n = manifold.n_q
    R = rotation_exp(dx[n + 3 : n + 6]) @ state.R_palm_object
    return State(state.q + dx[:n], R, state.p_palm_object + dx[n : n + 3], state.params + dx[n + 6 :])


@pytest.mark.parametrize("name", TASKS)
def test_the_slope_is_that_of_the_value(name: str) -> None:
    settings, (solved, _) = case(name)
    manifold = ContactManifold(solved.task)
    measure = SlackMeasure(manifold, settings, solved.state)
    here = measure.at(solved.state)
    slope = measure.gradient(here)
    rng = np.random.default_rng(0)
    for _ in range(4):
        dx = rng.normal(size=manifold.n_tangent)
        dx[manifold.n_q : manifold.n_q + 3] *= 0.05
        ends = [measure.at(displaced(manifold, solved.state, sign * 1e-6 * dx)).value for sign in (1, -1)]
        rise = (ends[0] - ends[1]) / 2e-6
        assert slope @ dx == pytest.approx(rise, rel=0.02, abs=1e-3 * np.abs(slope).max())


@pytest.mark.parametrize("name", TASKS)
def test_there_is_slack_where_the_load_is_carried(name: str) -> None:
    """By the program of the largest load, which knows nothing of slack."""
    settings, configurations = case(name)
    for configuration in configurations:
        manifold = ContactManifold(configuration.task)
        strength = StrengthMeasure(manifold, settings, configuration.state).at(configuration.state)
        slack_N = planned_slack(configuration, settings=settings)
        assert (slack_N > 0.0) == (strength.balanced and strength.value > settings.planned_load)


def test_twice_the_load_with_twice_the_servos_has_twice_the_slack() -> None:
    settings, (_, configuration) = case("transportation")
    half = replace(settings, planned_effort=0.5 * settings.planned_effort, gravity=0.5 * settings.gravity)
    slack_N = planned_slack(configuration, settings=settings)
    assert slack_N == pytest.approx(2.0 * planned_slack(configuration, settings=half), rel=1e-6)


def test_less_friction_never_leaves_more() -> None:
    settings, (_, configuration) = case("holding")
    friction = settings.sliding_friction(configuration.task.object)
    slacks = [
        planned_slack(configuration, settings=replace(settings, friction=share * friction))
        for share in (0.7, 0.85, 1.0)
    ]
    assert slacks == sorted(slacks) and slacks[0] < slacks[-1]
