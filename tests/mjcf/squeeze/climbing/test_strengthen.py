"""Strengthening: along the contacts, uphill, and by the true slope."""

from dataclasses import replace

import numpy as np
from holdfast.mjcf import HoldSettings, NotHoldable, Squeeze, plan_squeeze
from holdfast.mjcf.squeeze.climbing.strengthen import strengthen
from holdfast.solver import Configuration, ContactManifold

SETTINGS = HoldSettings()


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
