"""The margin is the load at which a grasp first fails, whatever it does beyond."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import Grasp, HoldSettings, find_margin, hold_margin, hold_test
from holdfast.mjcf.hold.trials.margin import first_failure

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


@pytest.mark.parametrize("limit", [0.0, 0.01, 0.3, 0.5, 0.99, 1.0, 1.7, 5.0, 7.99])
def test_bisection_finds_where_it_fails(limit: float) -> None:
    found = first_failure(lambda load: load <= limit, 8.0, 0.05)
    assert found <= limit
    assert limit - found <= 0.05 * max(limit, 0.5) / 0.95


def test_nothing_is_tried_beyond_the_cap() -> None:
    tried = []

    def holds(load: float) -> bool:
        tried.append(load)
        return True

    assert first_failure(holds, 3.0, 0.05) == 3.0
    assert tried == [1.0, 2.0, 3.0]
    assert first_failure(holds, 0.0, 0.05) == 0.0


def test_what_holds_again_beyond_a_failure_does_not_count() -> None:
    found = first_failure(lambda load: load < 1.3 or load > 3.0, 8.0, 0.01)
    assert 1.28 < found < 1.3


def test_a_load_that_passes_counts_whatever_a_smaller_one_does() -> None:
    """A margin is at least 1 exactly where the test is passed, also where half the load is too little."""
    assert first_failure(lambda load: 0.8 < load < 1.3, 8.0, 0.01) > 1.28
    assert first_failure(lambda load: load < 0.3, 8.0, 0.01) == pytest.approx(0.3, abs=0.01)


def test_each_load_is_tried_once() -> None:
    tried: list[float] = []

    def holds(load: float) -> bool:
        tried.append(load)
        return load < 1.4

    first_failure(holds, 8.0, 0.05)
    assert len(tried) == len(set(tried))


def test_a_margin_is_held_and_a_little_more_is_not(leaning: Grasp) -> None:
    margin = hold_margin(leaning, settings=SHORT)
    assert 1.0 <= margin < SHORT.margin_cap
    assert hold_test(leaning, settings=replace(SHORT, gravity=margin * SHORT.gravity)).held
    beyond = margin / (1.0 - SHORT.margin_resolution)
    assert not hold_test(leaning, settings=replace(SHORT, gravity=beyond * SHORT.gravity)).held


@pytest.mark.parametrize("friction", [0.45, 0.6])
def test_a_margin_of_one_is_the_verdict(grasp: Grasp, friction: float) -> None:
    settings = replace(SHORT, friction=friction)
    assert (hold_margin(grasp, settings=settings) >= 1.0) == hold_test(grasp, settings=settings).held


def test_twice_the_gravity_is_half_the_margin(firm: Grasp) -> None:
    once = hold_margin(firm, settings=SHORT)
    twice = hold_margin(firm, settings=replace(SHORT, gravity=2.0 * SHORT.gravity))
    assert twice == pytest.approx(0.5 * once, rel=2.0 * SHORT.margin_resolution)


def test_the_weakest_direction_decides(firm: Grasp) -> None:
    margins = [hold_margin(firm, settings=replace(SHORT, directions=(d,))) for d in SHORT.directions]
    both = hold_margin(firm, settings=SHORT)
    assert both == pytest.approx(min(margins), rel=SHORT.margin_resolution)


def test_a_direction_that_gives_way_first_comes_first(firm: Grasp) -> None:
    margins = {d: hold_margin(firm, settings=replace(SHORT, directions=(d,))) for d in SHORT.directions}
    found = find_margin(firm, settings=SHORT)
    assert margins[found.weakest[0]] == min(margins.values())


def test_a_hand_that_does_not_squeeze_has_no_margin(firm: Grasp) -> None:
    limp = replace(firm.squeeze, targets=np.array(firm.configuration.state.q))
    assert hold_margin(replace(firm, squeeze=limp), settings=SHORT) < 0.1
