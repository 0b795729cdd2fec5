"""Trials with noise."""

import pytest
from holdfast.mjcf import Grasp, HoldSettings, Noise, hold_probability, hold_test
from holdfast.mjcf.hold.trials.robustness import Robustness

from ..conftest import limp

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_trials_repeat_with_their_seed_and_more_trials_repeat_the_first(firm: Grasp) -> None:
    few = hold_probability(firm, settings=SHORT, noise=Noise(trials=3, seed=4))
    more = hold_probability(firm, settings=SHORT, noise=Noise(trials=5, seed=4))
    assert more.held[:3] == few.held
    assert few.probability == sum(few.held) / 3


def test_without_noise_every_trial_is_the_test(grasp: Grasp) -> None:
    still = Noise(0.0, 0.0, 0.0, trials=2)
    for tried in (grasp, limp(grasp)):
        assert set(hold_probability(tried, settings=SHORT, noise=still).held) == {
            hold_test(tried, settings=SHORT).held
        }


def test_much_noise_holds_less_often_than_little(firm: Grasp) -> None:
    little = hold_probability(firm, settings=SHORT, noise=Noise(0.0005, 0.005, 0.05, trials=6))
    much = hold_probability(firm, settings=SHORT, noise=Noise(0.02, 0.5, 0.8, trials=6))
    assert little.probability > much.probability


def test_the_standard_error_is_that_of_a_binomial() -> None:
    half = Robustness(Noise(trials=100), (True, False) * 50)
    assert half.standard_error == pytest.approx(0.05, rel=1e-3)
    assert Robustness(Noise(), (True,) * 10).standard_error > 0.0
