"""A grasp and its approach."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, hold_test

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_an_approach_that_is_known_is_not_looked_for(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    found = firm.approach
    monkeypatch.setattr("holdfast.mjcf.model.held_grasp.find_approach", lambda _: pytest.fail("looked for"))
    again = replace(firm, known_approach=found)
    assert again.approach is found
    result = hold_test(again, settings=SHORT)
    assert result.squeeze_slip_m == hold_test(firm, settings=SHORT).squeeze_slip_m


def test_a_grasp_that_sinks_in_begins_open_all_the_same(firm: Grasp) -> None:
    """Its approach is not reachable, and takes the fingers off the object."""
    configuration = firm.configuration
    state = configuration.state
    closing = state.q - firm.approach.waypoints[-2]
    deeper = np.clip(state.q + 0.5 * closing, *configuration.task.limits.T)
    sunk = replace(configuration, state=replace(state, q=deeper))
    approach = replace(firm, configuration=sunk).approach
    assert not approach.reachable and approach.blocking is not None
    assert approach.opening_m > 0.005
    assert hold_test(replace(firm, configuration=sunk), settings=SHORT).penetration_m > 5e-4
