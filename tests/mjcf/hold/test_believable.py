"""Verdicts that don't depend on the simulator's settings, creep within its budget, trials with noise."""

from dataclasses import replace
from itertools import pairwise

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, rotation_from_quaternion
from holdfast.mjcf import Grasp, HoldSettings, Noise, hold_probability, hold_test, settings_agreement
from holdfast.mjcf.hold.agreement import variants
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.placement import Placement
from holdfast.mjcf.hold.robustness import Robustness

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def limp(grasp: Grasp) -> Grasp:
    return replace(grasp, squeeze=replace(grasp.squeeze, targets=np.array(grasp.configuration.state.q)))


def test_other_numerical_settings_agree(grasp: Grasp) -> None:
    agreement = settings_agreement(grasp, hold_test(grasp, settings=SHORT))
    assert agreement.held and agreement.agree
    assert len(agreement.variants) == 3


def test_other_numerical_settings_agree_on_a_drop(firm: Grasp) -> None:
    agreement = settings_agreement(limp(firm), hold_test(limp(firm), settings=SHORT))
    assert not agreement.held and agreement.agree


def test_variants_differ_in_one_thing_each() -> None:
    changed = []
    for other in variants(SHORT).values():
        names = [name for name in SHORT.__dataclass_fields__ if getattr(SHORT, name) != getattr(other, name)]
        changed += names
    assert changed == ["timestep_s", "solver", "noslip_iterations"]


def test_a_verdict_that_differs_is_no_agreement(firm: Grasp) -> None:
    result = hold_test(limp(firm), settings=SHORT)
    claimed = replace(result, directions=hold_test(firm, settings=SHORT).directions, squeeze_slip_m=0.0)
    claimed = replace(claimed, squeeze_rotation_rad=0.0)
    assert claimed.held
    assert not settings_agreement(limp(firm), claimed).agree


def test_creep_stays_within_the_budget(grasp: Grasp) -> None:
    result = hold_test(grasp)
    assert result.is_at_rest
    assert result.creep_m_s <= HoldSettings().creep_budget_m_s
    for direction in result.directions:
        late = direction.times_s >= 1.5 - 1e-9
        change = abs(direction.slip_curve_m[-1] - direction.slip_curve_m[late][0])
        assert direction.creep_m_s == pytest.approx(change / 0.5)


def test_without_the_no_slip_solver_it_creeps_beyond_the_budget(leaning: Grasp) -> None:
    slow = replace(SHORT, hold_s=2.0)
    soft = replace(slow, noslip_iterations=0, impratio=1.0)
    firmly, softly = hold_test(leaning, settings=slow), hold_test(leaning, settings=soft)
    assert firmly.is_at_rest
    assert softly.creep_m_s > 10.0 * firmly.creep_m_s
    assert not softly.is_at_rest


def test_the_test_begins_at_the_pregrasp_of_the_approach(
    grasp: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In `close_s` the servos are driven along the approach's waypoints, to the grasp itself."""
    driven = []
    lift = Lift(grasp, SHORT)
    step = mujoco.mj_step

    def record(model: mujoco.MjModel, data: mujoco.MjData, count: int = 1) -> None:
        driven.append(np.array(data.ctrl))
        step(model, data, count)

    monkeypatch.setattr(mujoco, "mj_step", record)
    lift.squeeze()
    closing = np.array(driven[: round(SHORT.close_s / SHORT.timestep_s)])
    waypoints = grasp.approach.waypoints
    assert len(waypoints) > 2 and grasp.approach.reachable
    assert closing[-1] == pytest.approx(grasp.configuration.state.q, abs=1e-12)
    pace = np.abs(np.diff(closing, axis=0)).max(axis=1)
    assert pace.max() < 1.01 * np.abs(np.diff(waypoints, axis=0)).max(axis=1).sum() / len(closing)
    for targets in closing:
        # On one of the lines between waypoints.
        off = []
        for start, end in pairwise(waypoints):
            line = end - start
            share = np.clip((targets - start) @ line / (line @ line), 0.0, 1.0)
            off.append(np.abs(start + share * line - targets).max())
        assert min(off) < 1e-9


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


def test_the_object_starts_where_it_is_placed(firm: Grasp) -> None:
    """It is shifted, and turned about the middle of its contact points."""
    turn = axis_rotation(np.array([0.0, 0.0, 1.0]), 0.1)
    shift = np.array([0.001, -0.002, 0.003])
    start = Lift(firm, SHORT, Placement(shift, turn))._start
    state, points = firm.configuration.state, firm.configuration.contact_points
    R = rotation_from_quaternion(start[3:])
    assert pytest.approx(turn @ state.R_palm_object, abs=1e-12) == R
    middle = np.mean([point.p_object for point in points], axis=0)
    local = state.R_palm_object.T @ (middle - state.p_palm_object)
    assert R @ local + start[:3] - middle == pytest.approx(shift, abs=1e-12)


def test_the_standard_error_is_that_of_a_binomial() -> None:
    half = Robustness(Noise(trials=100), (True, False) * 50)
    assert half.standard_error == pytest.approx(0.05, rel=1e-3)
    assert Robustness(Noise(), (True,) * 10).standard_error > 0.0
