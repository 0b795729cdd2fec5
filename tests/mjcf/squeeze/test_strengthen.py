"""Strengthening: along the contacts, uphill, and by the true slope."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import HoldSettings, NotHoldable, Squeeze, plan_squeeze
from holdfast.mjcf.squeeze.grasp_strength import StrengthMeasure, displaced
from holdfast.mjcf.squeeze.strengthen import strengthen
from holdfast.objects import load_task
from holdfast.solver import Configuration, ContactManifold, solve

SETTINGS = HoldSettings()


@pytest.fixture(scope="module")
def configurations() -> tuple[Configuration, ...]:
    return solve(load_task("upholding"), candidates=6, seed=1).configurations


def load_factor(configuration: Configuration) -> float:
    squeeze = plan_squeeze(configuration, settings=SETTINGS)
    return 0.0 if isinstance(squeeze, NotHoldable) else squeeze.load_factor


def test_grasps_get_stronger_and_stay_solutions(configurations: tuple[Configuration, ...]) -> None:
    manifold = ContactManifold(configurations[0].task)
    before, after = [], []
    for configuration in configurations:
        stronger = strengthen(configuration, settings=SETTINGS)
        assert stronger.certified
        assert stronger.residual_m < 1e-12
        assert manifold.is_feasible(stronger.state)
        before.append(load_factor(configuration))
        after.append(load_factor(stronger))
        # The planner's finer cones allow a little more than the coarse ones climbed on.
        assert after[-1] >= before[-1] - 0.05
    # One in twenty climbs to where no step helps.
    assert sorted(after)[1] > 1.0 > np.median(before)


def test_a_strong_grasp_is_left_as_it_is(configurations: tuple[Configuration, ...]) -> None:
    # One friction to plan with, so that the plan and the climb measure the same.
    wish = HoldSettings(planned_friction=1.0, planned_load=0.5)
    strong = [
        reached
        for reached in (strengthen(configuration, settings=SETTINGS) for configuration in configurations)
        if isinstance(squeeze := plan_squeeze(reached, settings=replace(wish, planned_load=1.0)), Squeeze)
        and squeeze.load_factor > 0.99
    ]
    assert strong
    assert all(strengthen(configuration, settings=wish) is configuration for configuration in strong)


def test_the_same_configuration_gives_the_same_result(configurations: tuple[Configuration, ...]) -> None:
    a, b = (strengthen(configurations[1], settings=SETTINGS).state for _ in range(2))
    assert np.array_equal(a.q, b.q) and np.array_equal(a.R_palm_object, b.R_palm_object)


@pytest.mark.parametrize("stronger", [False, True])
def test_the_slope_is_that_of_the_value(stronger: bool, configurations: tuple[Configuration, ...]) -> None:
    """Both measures: unbalanced contact forces of a fresh configuration, the load of a stronger one."""
    manifold = ContactManifold(configurations[0].task)
    measure = StrengthMeasure(manifold, SETTINGS)
    weak = [c for c in configurations if measure.at(c.state).value < 0.0]
    if stronger:
        weak = [
            strengthen(replace(c, certificate=None), settings=HoldSettings(planned_load=0.4)) for c in weak
        ]
    here = next(here for c in weak if (here := measure.at(c.state)).balanced is stronger)
    slope = measure.gradient(here)
    rng = np.random.default_rng(0)
    for _ in range(5):
        dx = rng.normal(size=manifold.n_tangent)
        ends = [measure.at(displaced(manifold, here.state, sign * 1e-5 * dx)).value for sign in (1, -1)]
        assert slope @ dx == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=0.05, abs=1e-3)
