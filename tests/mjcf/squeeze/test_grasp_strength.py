"""The slope of a grasp's strength is that of its value."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import HoldSettings
from holdfast.mjcf.squeeze.grasp_strength import StrengthMeasure, displaced
from holdfast.mjcf.squeeze.strengthen import strengthen
from holdfast.solver import Configuration, ContactManifold

SETTINGS = HoldSettings()


@pytest.mark.parametrize("stronger", [False, True])
def test_the_slope_is_that_of_the_value(stronger: bool, configurations: tuple[Configuration, ...]) -> None:
    """Both measures: unbalanced contact forces of a fresh configuration, the load of a stronger one."""
    manifold = ContactManifold(configurations[0].task)
    measure = StrengthMeasure(manifold, SETTINGS, configurations[0].state)
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
