"""The models of grasps and of tasks' tests agree with the grasp, and MuJoCo can run them."""

import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pytest
from holdfast.hands import forward_kinematics
from holdfast.mjcf import Grasp, HoldSettings, grasp_mjcf, trial_mjcf
from holdfast.mjcf.model import compiled_model
from holdfast.mjcf.model.start import weigh_in
from holdfast.objects import PressTest
from holdfast.solver import Configuration

from ..conftest import in_mujoco

SHORT = HoldSettings(hold_s=1.0)


def test_the_keyframe_is_the_grasp(grasp: Grasp) -> None:
    configuration = grasp.configuration
    model, data = in_mujoco(grasp_mjcf(configuration, targets=grasp.squeeze.targets))
    mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
    mujoco.mj_forward(model, data)
    assert data.body("object").xpos == pytest.approx(configuration.state.p_palm_object, abs=1e-9)
    R = data.body("object").xmat.reshape(3, 3)
    assert pytest.approx(configuration.state.R_palm_object, abs=1e-9) == R
    for i, point in enumerate(configuration.contact_points):
        assert data.site(f"contact/{i}").xpos == pytest.approx(point.p_object, abs=1e-9)
        assert data.site(f"contact/{i}").xmat.reshape(3, 3)[:, 2] == pytest.approx(point.n_object, abs=1e-9)
    assert np.abs(data.actuator_force).max() < 1e-9, "at rest, the servos do nothing"
    q = configuration.state.q
    assert model.key("grasp").ctrl == pytest.approx(q - grasp.squeeze.targets, abs=1e-9)
    assert not model.key("squeeze").ctrl.any(), "controls count from the squeeze"


def test_the_model_begins_in_the_grasp(configuration: Configuration) -> None:
    """Without any keyframe hand and object are where the grasp has them, and nothing pushes them apart."""
    model = mujoco.MjModel.from_xml_string(trial_mjcf(configuration, settings=SHORT))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    places = data.qpos.copy(), data.xpos.copy(), data.xmat.copy(), data.xanchor.copy(), data.xaxis.copy()
    assert data.qpos[: len(configuration.joint_vector)] == pytest.approx(configuration.joint_vector, abs=1e-9)
    T = forward_kinematics(configuration.task.hand, configuration.joint_vector)
    for link, T_link in zip(configuration.task.hand.links, T, strict=True):
        assert data.body(link.name).xpos == pytest.approx(T_link[:3, 3], abs=1e-9)
        assert data.body(link.name).xmat.reshape(3, 3) == pytest.approx(T_link[:3, :3], abs=1e-9)
    mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
    mujoco.mj_forward(model, data)
    again = data.qpos, data.xpos, data.xmat, data.xanchor, data.xaxis
    for there, here in zip(again, places, strict=True):
        assert there == pytest.approx(here, abs=1e-9)
    # Joints mean what they mean in the hand: at zero the links are where its zero has them.
    data.qpos[: len(configuration.joint_vector)] = configuration.task.hand.expand(0.0 * configuration.state.q)
    mujoco.mj_forward(model, data)
    zero = forward_kinematics(
        configuration.task.hand, configuration.task.hand.expand(0.0 * configuration.state.q)
    )
    for link, T_link in zip(configuration.task.hand.links, zero, strict=True):
        assert data.body(link.name).xpos == pytest.approx(T_link[:3, 3], abs=1e-9)
    assert np.abs(data.efc_pos[data.efc_type == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)]).max() < 1e-9


def fall(model: mujoco.MjModel, gravity: np.ndarray, ctrl: np.ndarray | float = 0.0) -> float:
    """How far (m) the object goes in half a second from where the model begins, without a keyframe."""
    data = mujoco.MjData(model)
    data.ctrl[:] = ctrl
    model.opt.gravity[:] = 0.0
    mujoco.mj_step(model, data, 100)
    model.opt.gravity[:] = gravity
    before = data.body("object").xpos.copy()
    mujoco.mj_step(model, data, round(0.5 / model.opt.timestep))
    return float(np.linalg.norm(data.body("object").xpos - before))


def test_loaded_and_stepped_the_model_holds_the_object(grasp: Grasp, tmp_path: Path) -> None:
    """As any program would: no keyframe, no control; in each direction of the grasp's own test."""
    path = tmp_path / "grasp.xml"
    path.write_text(grasp.mjcf(), "utf-8")
    model, settings = mujoco.MjModel.from_xml_path(str(path)), grasp.squeeze.settings
    for direction in settings.directions:
        assert fall(model, settings.gravity * np.array(direction)) < settings.slip_limit_m
    resting = grasp.configuration.state.q - grasp.squeeze.targets
    assert fall(model, np.array([0.0, 0.0, -settings.gravity]), resting) > 10.0 * settings.slip_limit_m


def test_without_a_squeeze_the_model_rests_in_the_grasp(configuration: Configuration) -> None:
    model, data = in_mujoco(trial_mjcf(configuration, settings=SHORT))
    mujoco.mj_forward(model, data)
    assert not model.key("grasp").ctrl.any()
    assert np.abs(data.actuator_force).max() < 1e-9


def test_pads_weigh_what_the_posture_makes_of_them(firm: Grasp) -> None:
    """MuJoCo itself, given the text, finds the inverse masses that pads were made for."""
    compiled = mujoco.MjModel.from_xml_string(firm.mjcf())
    model = compiled_model(firm.configuration.task, firm.squeeze.settings)
    straight = model.body_invweight0[:, 0].copy()
    weigh_in(model, firm.configuration.joint_vector)
    assert model.body_invweight0[:, 0] == pytest.approx(compiled.body_invweight0[:, 0], rel=1e-9)
    assert np.abs(straight - model.body_invweight0[:, 0]).max() > 0.05 * straight.max()


def test_contacts_take_the_friction_of_the_settings(firm: Grasp) -> None:
    settings = HoldSettings(friction=0.45, patch_radius_m=0.006)
    model, data = in_mujoco(grasp_mjcf(firm.configuration, settings=settings))
    mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
    data.qpos[-7:-4] += 1e-4 * firm.configuration.contact_points[0].n_object  # into the first finger
    mujoco.mj_forward(model, data)
    body = model.body("object").id
    ours = [c for c in data.contact[: data.ncon] if body in model.geom_bodyid[c.geom]]
    assert ours
    for contact in ours:
        assert contact.dim == 4
        assert contact.friction[:3] == pytest.approx([0.45, 0.45, 2.0 / 3.0 * 0.45 * settings.patch_radius_m])


def test_dense_and_sparse_agree(firm: Grasp) -> None:
    """MuJoCo 4.0.0 gets the sparse Newton Hessian wrong with elliptic cones; ours is dense and below 4."""
    text = grasp_mjcf(firm.configuration, targets=firm.squeeze.targets)
    assert ET.fromstring(text).find("option").get("jacobian") == "dense"
    paths = []
    for jacobian in (mujoco.mjtJacobian.mjJAC_DENSE, mujoco.mjtJacobian.mjJAC_SPARSE):
        model, data = in_mujoco(text)
        model.opt.jacobian = jacobian
        mujoco.mj_resetDataKeyframe(model, data, model.key("squeeze").id)
        model.opt.gravity[:] = [0.0, 0.0, -9.81]
        mujoco.mj_step(model, data, 20)
        mujoco.mj_forward(model, data)
        assert data.ncon >= 2
        paths.append(np.concatenate([data.qpos, data.qacc]))
    assert paths[0] == pytest.approx(paths[1], rel=1e-6, abs=1e-6)


def test_equal_input_gives_equal_text(firm: Grasp) -> None:
    text = grasp_mjcf(firm.configuration)
    assert text == grasp_mjcf(firm.configuration)
    assert text.startswith("<mujoco model=")
    assert "\n  <option" in text


def test_a_model_needs_no_other_file(firm: Grasp, tmp_path: Path) -> None:
    path = tmp_path / "grasp.xml"
    path.write_text(grasp_mjcf(firm.configuration), "utf-8")
    assert mujoco.MjModel.from_xml_path(str(path)).nkey == 1


def test_the_model_of_the_test(configuration: Configuration) -> None:
    model = mujoco.MjModel.from_xml_string(trial_mjcf(configuration, settings=SHORT))
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
    model = mujoco.MjModel.from_xml_string(trial_mjcf(tuning, settings=SHORT))
    data = mujoco.MjData(model)
    friction = tuning.task.test.friction_torque_Nm
    for share, moves in ((0.9, False), (1.2, True)):
        mujoco.mj_resetDataKeyframe(model, data, model.key("grasp").id)
        model.geom_contype[:] = model.geom_conaffinity[:] = 0
        data.qfrc_applied[-1] = share * friction
        mujoco.mj_step(model, data, 250)
        assert bool(abs(data.qpos[-1]) > np.deg2rad(5.0)) is moves
