"""Intervals cover what they should, as often as they should."""

import numpy as np
import pytest
from holdfast.pipeline.choose.study.intervals import (
    interquartile_mean,
    iqm_over_seeds,
    mean_over_objects,
    ratio_over_objects,
)


def test_intervals_cover_a_known_mean() -> None:
    """Situations of an object go together, so that intervals over situations would be far too narrow."""
    rng = np.random.default_rng(0)
    names = np.repeat([f"object {k}" for k in range(40)], 4)
    covered = 0
    for seed in range(200):
        values = 0.3 + np.repeat(rng.normal(size=40), 4) + 0.1 * rng.normal(size=160)
        found = mean_over_objects(values, names, seed=seed, samples=400)
        assert found.low <= found.value <= found.high
        covered += found.low <= 0.3 <= found.high
    assert 0.89 <= covered / 200 <= 0.99


def test_what_is_no_number_is_left_out() -> None:
    names = np.array(["a", "a", "b"])
    assert mean_over_objects(np.array([1.0, np.nan, 3.0]), names).value == 2.0
    nothing = mean_over_objects(np.full(3, np.nan), names)
    assert nothing.as_list == [None, None, None]
    assert ratio_over_objects(np.ones(3), np.zeros(3), names).as_list == [None, None, None]


def test_a_ratio_is_one_of_sums() -> None:
    names = np.array(["a", "b", "b"])
    found = ratio_over_objects(np.array([1.0, 2.0, 3.0]), np.array([2.0, 4.0, 6.0]), names)
    assert found.as_list == [0.5, 0.5, 0.5]


def test_the_middle_half_alone_counts() -> None:
    assert interquartile_mean(np.array([[-1e9, 1.0], [2.0, 1e9]])) == 1.5
    values = np.random.default_rng(0).random(40)
    assert interquartile_mean(values) == pytest.approx(np.sort(values)[10:30].mean())


def test_runs_are_resampled_within_strata() -> None:
    """Strata that differ while runs agree leave nothing to be unsure of."""
    agreeing = np.tile([0.1, 0.5, 0.9, 0.3], (5, 1))
    found = iqm_over_seeds(agreeing)
    assert found.low == pytest.approx(found.high) == pytest.approx(found.value)
    noisy = agreeing + 0.1 * np.random.default_rng(0).normal(size=agreeing.shape)
    assert iqm_over_seeds(noisy).low < iqm_over_seeds(noisy).value < iqm_over_seeds(noisy).high
    assert iqm_over_seeds(noisy, seed=1).as_list == iqm_over_seeds(noisy, seed=1).as_list
