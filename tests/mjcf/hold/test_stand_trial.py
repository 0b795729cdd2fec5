"""Turns and presses: what is planned, what is passed, and controls that must fail."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation
from holdfast.mjcf import (
    Grasp,
    HoldSettings,
    Noise,
    NotHoldable,
    Obstacle,
    Outcome,
    Squeeze,
    find_margin,
    hold_margin,
    hold_probability,
    hold_test,
    plan_squeeze,
    settings_agreement,
)
from holdfast.mjcf.hold.placement import Placement, placed
from holdfast.mjcf.hold.stand_trial import StandTrial
from holdfast.mjcf.model import grasp_qpos
from holdfast.mjcf.squeeze.pads import contact_pads
from holdfast.mjcf.squeeze.statics import grasp_statics
from holdfast.objects import PressTest, TurnTest
from holdfast.solver import Configuration

from ..conftest import limp, servo_efforts

SHORT = HoldSettings(hold_s=1.0)


def with_test(configuration: Configuration, **changes: object) -> Configuration:
    task = configuration.task
    return replace(configuration, task=replace(task, test=replace(task.test, **changes)))


def planned(configuration: Configuration, settings: HoldSettings = SHORT) -> Grasp:
    squeeze = plan_squeeze(configuration, settings=settings)
    assert isinstance(squeeze, Squeeze)
    return Grasp(configuration, squeeze)


def test_a_squeeze_on_a_stand_keeps_cones_and_efforts(configuration: Configuration) -> None:
    squeeze = planned(configuration).squeeze
    obj = configuration.task.object
    mu, pads = SHORT.sliding_friction(obj), contact_pads(configuration, SHORT)
    for vector in squeeze.loaded:
        for (normal, first, second, torque), arm_m in zip(
            vector, pads.spin_arms_m(vector[:, 0]), strict=True
        ):
            assert normal > 0.0
            assert np.hypot(np.hypot(first, second), torque / (1.3 * arm_m)) <= mu * normal * (1.0 + 1e-9)
    statics = grasp_statics(configuration, SHORT)
    assert np.all(np.abs(statics.T @ squeeze.preload.ravel()) <= SHORT.planned_effort * statics.effort + 1e-9)
    pressed_in = squeeze.targets - squeeze.efforts / statics.stiffness
    efforts = servo_efforts(configuration, squeeze.targets, pressed_in)
    assert efforts == pytest.approx(squeeze.efforts, abs=1e-9)


def test_a_planned_press_presses_as_hard_as_asked(playing: Configuration) -> None:
    test = playing.task.test
    assert isinstance(test, PressTest)
    squeeze = planned(playing).squeeze
    # A press is planned for a third more than other loads.
    assert squeeze.load_factor == pytest.approx(4.0 / 3.0 * SHORT.planned_load, rel=1e-5)
    for i in test.contacts:
        assert squeeze.preload[i, 0] >= squeeze.load_factor * test.force_N - 1e-6


def test_a_planned_turn_overcomes_the_friction_of_the_hinge(tuning: Configuration) -> None:
    test = tuning.task.test
    assert isinstance(test, TurnTest)
    squeeze, state = planned(tuning).squeeze, tuning.state
    axis = state.R_palm_object @ np.array(test.hinge_axis)
    hinge = state.R_palm_object @ np.array(test.hinge_point) + state.p_palm_object
    frames = grasp_statics(tuning, SHORT).frames
    torque = 0.0
    for f, frame, point in zip(squeeze.preload, frames, tuning.contact_points, strict=True):
        torque += axis @ (np.cross(point.p_object - hinge, f[:3] @ frame) + f[3] * frame[0])
    assert torque == pytest.approx(squeeze.load_factor * test.friction_torque_Nm, rel=1e-6)
    assert squeeze.load_factor > 1.0


def test_pads_are_springs_of_the_forces_along_the_whole_turn(tuning: Configuration) -> None:
    """And not of the squeeze alone, where the finger that pushes later may hardly press."""
    squeeze = planned(tuning).squeeze
    pad = contact_pads(tuning, SHORT)
    mean_N = np.array([pads[:, 0] for pads in squeeze.loaded]).mean(axis=0)
    stiffness = squeeze.pads.normals_N / squeeze.pads.yields_m
    assert len(squeeze.loaded) > 1 and np.ptp(squeeze.loaded[:, :, 0], axis=0).max() > 0.5
    assert stiffness == pytest.approx(mean_N / pad.yields_m(mean_N))


def test_passed(configuration: Configuration) -> None:
    grasp = planned(configuration)
    result = hold_test(grasp)
    (trial,) = result.directions
    assert trial.outcome is Outcome.HELD and result.held
    assert result.kind == {"playing": "press", "tuning": "turn"}[configuration.task.name]
    assert result.slip_m < SHORT.slip_limit_m
    assert all(trial.touching)
    if result.kind == "turn":
        assert trial.rotation_rad >= configuration.task.test.angle_rad
    assert trial.qpos.shape == (len(trial.times_s), len(configuration.joint_vector) + 7)
    again = hold_test(grasp)
    assert np.array_equal(again.directions[0].qpos, trial.qpos)


def test_other_numerical_settings_agree(playing: Configuration) -> None:
    grasp = planned(playing)
    assert settings_agreement(grasp, hold_test(grasp)).agree


def test_a_hand_that_does_not_squeeze_fails(configuration: Configuration) -> None:
    grasp = planned(configuration)
    result = hold_test(limp(grasp))
    assert not result.held
    if result.kind == "turn":
        assert abs(result.directions[0].rotation_rad) < np.deg2rad(1.0)


@pytest.mark.parametrize(("samples", "outcome"), [(0, Outcome.HELD), (5, Outcome.HELD), (99, Outcome.LET_GO)])
def test_a_contact_that_comes_back_at_once_is_not_lost(
    samples: int, outcome: Outcome, configuration: Configuration, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a lift: one contact shows no force at so many samples from the end on."""
    trial = StandTrial(planned(configuration), SHORT)
    simulation = trial.simulation
    real, seen = simulation.normal_forces, []

    def flickering() -> np.ndarray:
        seen.append(simulation.data.time)
        return real() * (np.arange(len(real())) > 0 if len(seen) <= samples else 1.0)

    monkeypatch.setattr(simulation, "normal_forces", flickering)
    result = trial.run()
    assert result.directions[0].outcome is outcome
    # It is looked at when all is done, for half a second at most.
    assert seen[-1] - seen[0] <= 0.5 + 1e-9


def test_a_stuck_hinge_does_not_turn(tuning: Configuration) -> None:
    """The plan is for the hinge as it should be; this one has twenty times its friction."""
    grasp = planned(tuning)
    stuck = with_test(tuning, friction_torque_Nm=20.0 * tuning.task.test.friction_torque_Nm)
    result = hold_test(replace(grasp, configuration=stuck))
    assert not result.held
    assert result.directions[0].rotation_rad < 0.5 * tuning.task.test.angle_rad


def test_less_force_than_asked_is_weak(playing: Configuration) -> None:
    grasp = planned(playing)
    wished = with_test(playing, force_N=10.0 * playing.task.test.force_N)
    result = hold_test(replace(grasp, configuration=wished))
    assert result.directions[0].outcome is Outcome.WEAK


def test_more_than_the_servos_can_do_is_not_holdable(configuration: Configuration) -> None:
    change = {"playing": {"force_N": 9000.0}, "tuning": {"friction_torque_Nm": 90.0}}
    outcome = plan_squeeze(with_test(configuration, **change[configuration.task.name]), settings=SHORT)
    assert isinstance(outcome, NotHoldable)
    assert outcome.obstacle is Obstacle.EFFORT


def test_a_turn_that_fingers_cannot_follow_is_not_holdable(tuning: Configuration) -> None:
    outcome = plan_squeeze(with_test(tuning, angle_rad=3.0), settings=SHORT)
    assert outcome == NotHoldable(Obstacle.REACH, 0.0)


@pytest.mark.parametrize("slip_limit_m", [0.005, 1e-5])
def test_the_verdict_alone_is_that_of_the_whole_test(slip_limit_m: float, playing: Configuration) -> None:
    """And where the test can't be passed any more, it is known sooner."""
    settings = replace(SHORT, slip_limit_m=slip_limit_m)
    whole, alone = (StandTrial(planned(playing), settings) for _ in range(2))
    held = whole.run().held
    assert alone.holds() is held
    sooner = alone.simulation.data.time < whole.simulation.data.time - 0.1
    assert sooner is not held


def test_a_margin_of_one_is_the_verdict_on_a_stand(configuration: Configuration) -> None:
    grasp = planned(configuration)
    for tried in (grasp, limp(grasp)):
        assert (hold_margin(tried) >= 1.0) == hold_test(tried).held
    assert hold_margin(limp(grasp)) < 0.5


def test_loads_of_one_turn_find_what_each_finds_alone(tuning: Configuration) -> None:
    """They share what comes before the friction of the hinge gives way, and that alone."""
    grasp = planned(tuning)
    trial = StandTrial(grasp, SHORT)
    turned = []
    for load in (1.0, 1.3, 0.9):
        held = trial.holds(load)
        shared = trial.run()
        alone = StandTrial(grasp, SHORT, load=load).run()
        assert (held, shared.held) == (alone.held, alone.held)
        ours, theirs = shared.directions[0], alone.directions[0]
        assert ours.rotation_rad == pytest.approx(theirs.rotation_rad, abs=1e-4)
        assert shared.squeezed_normals_N == pytest.approx(alone.squeezed_normals_N, abs=1e-3)
        turned.append(theirs.rotation_rad)
    assert turned[1] < turned[0] < turned[2]


def test_a_press_that_is_known_has_its_margin_from_its_test(playing: Configuration) -> None:
    grasp = planned(playing)
    result = hold_test(grasp)
    known = find_margin(grasp, held=result.held, pressed_N=result.pressed_N)
    assert known == find_margin(grasp) and known.value >= 1.0


def test_the_margin_of_a_turn_passes_and_a_little_more_fails(tuning: Configuration) -> None:
    grasp = planned(tuning)
    settings = replace(SHORT, margin_resolution=0.2)
    margin = hold_margin(grasp, settings=settings)
    friction = tuning.task.test.friction_torque_Nm
    for load, passes in ((margin, True), (margin / (1.0 - settings.margin_resolution), False)):
        loaded = with_test(tuning, friction_torque_Nm=load * friction)
        assert hold_test(replace(grasp, configuration=loaded)).held is passes


def test_the_margin_of_a_press_is_the_force_reached_over_the_one_asked_for(playing: Configuration) -> None:
    grasp = planned(playing)
    margin, force_N = hold_margin(grasp), playing.task.test.force_N
    result = hold_test(grasp)
    assert result.pressed_N == margin * force_N
    for share, passes in ((1.0 - 1e-6, True), (1.0 + 1e-6, False)):
        wished = with_test(playing, force_N=share * margin * force_N)
        assert hold_test(replace(grasp, configuration=wished)).held is passes


def test_twice_the_load_never_makes_a_failed_grasp_pass(configuration: Configuration) -> None:
    name = {"playing": "force_N", "tuning": "friction_torque_Nm"}[configuration.task.name]
    grasp = planned(configuration)
    verdicts = []
    for load in (1.0, 2.0, 4.0, 8.0):
        loaded = with_test(configuration, **{name: load * getattr(configuration.task.test, name)})
        verdicts.append(hold_test(replace(grasp, configuration=loaded)).held)
    assert verdicts == sorted(verdicts, reverse=True) and not verdicts[-1]


def test_without_noise_every_trial_on_a_stand_is_the_test(configuration: Configuration) -> None:
    grasp, still = planned(configuration), Noise(0.0, 0.0, 0.0, trials=1)
    for tried in (grasp, limp(grasp)):
        assert hold_probability(tried, settings=SHORT, noise=still).held == (hold_test(tried).held,)


def test_noise_on_a_stand_repeats_with_its_seed(configuration: Configuration) -> None:
    grasp = planned(configuration)
    few = hold_probability(grasp, settings=SHORT, noise=Noise(trials=2, seed=3))
    assert hold_probability(grasp, settings=SHORT, noise=Noise(trials=3, seed=3)).held[:2] == few.held
    # A hand that closes beside the object does nothing.
    far = hold_probability(grasp, settings=SHORT, noise=Noise(position_m=0.3, trials=2))
    assert far.probability == 0.0


def test_hinge_and_stand_are_off_with_the_object(tuning: Configuration) -> None:
    shift = np.array([0.001, 0.002, -0.001])
    turn = axis_rotation(np.array([0.0, 1.0, 0.0]), 0.03)
    trial = StandTrial(planned(tuning), SHORT, Placement(shift, turn))
    trial.run()
    model, data = trial.simulation.model, trial.simulation.data
    start = placed(tuning, grasp_qpos(tuning)[-7:], Placement(shift, turn))
    data.qpos[-1] = 0.0
    mujoco.mj_forward(model, data)
    R = turn @ tuning.state.R_palm_object
    for body in ("object", "stand"):
        assert data.body(body).xpos == pytest.approx(start[:3], abs=1e-12)
        assert data.body(body).xmat.reshape(3, 3) == pytest.approx(R, abs=1e-9)
    assert data.joint("object").xaxis == pytest.approx(R @ np.array(tuning.task.test.hinge_axis), abs=1e-9)
