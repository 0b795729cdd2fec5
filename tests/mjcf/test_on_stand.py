"""Turns and presses: what is planned, what is passed, and controls that must fail."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_from_quaternion
from holdfast.hands import forward_kinematics
from holdfast.mjcf import (
    Grasp,
    HoldSettings,
    NotHoldable,
    Obstacle,
    Outcome,
    Squeeze,
    hold_test,
    plan_squeeze,
    settings_agreement,
    trial_mjcf,
)
from holdfast.mjcf.statics import grasp_statics
from holdfast.mjcf.turn_path import turn_path, turned_pose
from holdfast.objects import PressTest, Task, TurnTest, load_task
from holdfast.solver import Configuration, ContactManifold, State

# Independent joints in rad, quaternion and position of the object in m, parameters of the patches: close to
# solutions without penetration.
_STARTS = {
    "playing": (
        [1.084, 0.251, 0.536, 0.309, -0.211, 1.133, 1.26, -0.108, 0.934, 0.315, 0.201, 0.178, 1.033],
        [0.0583, -0.2086, -0.5559, 0.8025],
        [1.1842, -0.1541, 0.6801],
        [0.169, 0.246, 0.322, 0.227, 0.678, 0.012, 0.66, 0.979],
    ),
    "tuning": (
        [1.397, -0.118, 0.01, 0.415, 0.0, 0.0, 0.07, 0.0, 0.0, 0.07, 0.262, 0.729, 0.291],
        [0.5457, 0.3025, -0.7695, -0.1362],
        [0.5317, 0.7474, -0.8367],
        [0.47, 0.141, 0.475, 0.95],
    ),
}
SHORT = HoldSettings(hold_s=1.0)


def with_test(configuration: Configuration, **changes: object) -> Configuration:
    task = configuration.task
    return replace(configuration, task=replace(task, test=replace(task.test, **changes)))


def planned(configuration: Configuration, settings: HoldSettings = SHORT) -> Grasp:
    squeeze = plan_squeeze(configuration, settings)
    assert isinstance(squeeze, Squeeze)
    return Grasp(configuration, squeeze)


@pytest.fixture(scope="module", params=["playing", "tuning"])
def configuration(request: pytest.FixtureRequest) -> Configuration:
    return configured(request.param)


@pytest.fixture(scope="module")
def playing() -> Configuration:
    return configured("playing")


@pytest.fixture(scope="module")
def tuning() -> Configuration:
    return configured("tuning")


def configured(name: str) -> Configuration:
    task: Task = load_task(name)
    q, quaternion, position, params = (np.array(values) for values in _STARTS[name])
    manifold = ContactManifold(task)
    R = rotation_from_quaternion(quaternion / np.linalg.norm(quaternion))
    state = manifold.project(State(q, R, position, params))
    assert state is not None and manifold.is_feasible(state)
    return Configuration(task, state, float(np.abs(manifold.residual(state)).max()), None)


def test_a_squeeze_on_a_stand_keeps_cones_and_efforts(configuration: Configuration) -> None:
    squeeze = planned(configuration).squeeze
    obj = configuration.task.object
    mu, mu_t = SHORT.sliding_friction(obj), SHORT.torsional_friction(obj)
    for normal, first, second, torque in squeeze.loaded.reshape(-1, 4):
        assert normal > 0.0
        assert np.hypot(np.hypot(first, second) / mu, torque / mu_t) <= normal * (1.0 + 1e-9)
    statics = grasp_statics(configuration, SHORT)
    assert np.all(np.abs(squeeze.efforts) <= SHORT.planned_effort * statics.effort + 1e-9)
    assert squeeze.targets == pytest.approx(configuration.state.q + squeeze.efforts / statics.stiffness)


def test_a_planned_press_presses_as_hard_as_asked(playing: Configuration) -> None:
    test = playing.task.test
    assert isinstance(test, PressTest)
    squeeze = planned(playing).squeeze
    assert squeeze.load_factor == pytest.approx(SHORT.planned_load, rel=1e-5)
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


def test_the_way_of_a_turn_keeps_the_contacts_and_rolls(tuning: Configuration) -> None:
    task, test = tuning.task, tuning.task.test
    way = turn_path(tuning, test, 5)
    assert len(way) == 5
    manifold = ContactManifold(task)
    slid = np.zeros(len(task.contacts))
    for k, (here, there) in enumerate(zip([tuning, *way], way, strict=False)):
        R, p = turned_pose(tuning.state, test, test.angle_rad * (k + 1) / 5)
        assert there.state.R_palm_object == pytest.approx(R, abs=1e-9)
        assert there.state.p_palm_object == pytest.approx(p, abs=1e-9)
        assert np.abs(manifold.residual(there.state)).max() < 1e-8
        assert np.all(task.limits[:, 0] - 1e-9 <= there.state.q)
        assert np.all(there.state.q <= task.limits[:, 1] + 1e-9)
        before, after = (forward_kinematics(task.hand, c.joint_vector) for c in (here, there))
        turn = there.state.T_palm_object @ np.linalg.inv(here.state.T_palm_object)
        for i, (contact, point) in enumerate(zip(task.contacts, here.contact_points, strict=True)):
            link = contact.hand.link
            moved = after[link] @ np.linalg.inv(before[link]) @ [*point.p_hand, 1.0]
            slid[i] += np.linalg.norm((moved - turn @ [*point.p_object, 1.0])[:3])
    # The contacts would slide by some 4 mm, a quarter of a radian at 15 mm, if the fingers stayed.
    assert slid.max() < 0.0015


def test_the_hinge_is_an_axis_of_the_turned_pose(tuning: Configuration) -> None:
    test, state = tuning.task.test, tuning.state
    R, p = turned_pose(state, test, 0.7)
    for along in (0.0, 0.1):
        point = np.array(test.hinge_point) + along * np.array(test.hinge_axis)
        there = state.R_palm_object @ point + state.p_palm_object
        assert R @ point + p == pytest.approx(there, abs=1e-12)


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
    q = configuration.state.q
    limp = replace(grasp.squeeze, targets=q, path=np.tile(q, (len(grasp.squeeze.path), 1)))
    result = hold_test(replace(grasp, squeeze=limp))
    assert not result.held
    if result.kind == "turn":
        assert abs(result.directions[0].rotation_rad) < np.deg2rad(1.0)


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
    outcome = plan_squeeze(with_test(configuration, **change[configuration.task.name]), SHORT)
    assert isinstance(outcome, NotHoldable)
    assert outcome.obstacle is Obstacle.EFFORT


def test_a_turn_that_fingers_cannot_follow_is_not_holdable(tuning: Configuration) -> None:
    outcome = plan_squeeze(with_test(tuning, angle_rad=3.0), SHORT)
    assert outcome == NotHoldable(Obstacle.REACH, 0.0)


def test_the_model_of_the_test(configuration: Configuration) -> None:
    model = mujoco.MjModel.from_xml_string(trial_mjcf(configuration, SHORT))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert data.body("object").xpos == pytest.approx(configuration.state.p_palm_object, abs=1e-9)
    joints = len(configuration.joint_vector)
    if isinstance(configuration.task.test, PressTest):
        assert model.njnt == joints
        return
    test = configuration.task.test
    assert model.njnt == joints + 1
    hinge = model.joint("object")
    assert model.dof_frictionloss[hinge.dofadr[0]] == test.friction_torque_Nm
    axis = configuration.state.R_palm_object @ np.array(test.hinge_axis)
    assert data.joint("object").xaxis == pytest.approx(axis, abs=1e-9)
    # What turns is the key alone, what stands is the rest.
    bodies = {model.body(model.geom_bodyid[i]).name for i in range(model.ngeom)}
    assert {"object", "stand"} <= bodies


def test_below_its_friction_the_hinge_holds_still(tuning: Configuration) -> None:
    model = mujoco.MjModel.from_xml_string(trial_mjcf(tuning, SHORT))
    data = mujoco.MjData(model)
    friction = tuning.task.test.friction_torque_Nm
    for share, moves in ((0.9, False), (1.2, True)):
        mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
        model.geom_contype[:] = model.geom_conaffinity[:] = 0
        data.qfrc_applied[-1] = share * friction
        mujoco.mj_step(model, data, 250)
        assert bool(abs(data.qpos[-1]) > np.deg2rad(5.0)) is moves
