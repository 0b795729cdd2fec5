"""Models of hands are posed by MuJoCo as our kinematics pose them."""

import sys
import xml.etree.ElementTree as ET

import mujoco
import numpy as np
import pytest
from holdfast.errors import MissingBackend
from holdfast.hands import builtin_hands, forward_kinematics, load_hand
from holdfast.objects import load_task
from holdfast.pipeline.exports import hand_urdf, keyframes_mjcf, usd_text
from holdfast.pipeline.records import read_run
from pxr import Usd, UsdGeom
from scipy.spatial.transform import Rotation


def links_in_mujoco(model, data, hand) -> np.ndarray:
    """Poses of the links in the palm's frame."""
    poses = np.tile(np.eye(4), (len(hand.links), 1, 1))
    for i, link in enumerate(hand.links):
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link.name)
        # The root of a URDF is the world.
        poses[i, :3, :3] = data.xmat[max(body, 0)].reshape(3, 3)
        poses[i, :3, 3] = data.xpos[max(body, 0)]
    return np.linalg.inv(poses[0]) @ poses


@pytest.mark.parametrize("name", builtin_hands())
def test_urdf_has_the_hands_kinematics_mass_and_couplings(name):
    hand = load_hand(name)
    files = hand_urdf(hand)
    text = files.pop(f"{hand.name}.urdf")
    model = mujoco.MjModel.from_xml_string(text, {path: data.encode() for path, data in files.items()})
    data = mujoco.MjData(model)
    rng = np.random.default_rng(0)
    for _ in range(3):
        lower, upper = hand.limits[:, 0], hand.limits[:, 1]
        q = hand.expand(rng.uniform(lower, upper))
        for joint, position in zip(hand.joint_names, q, strict=True):
            data.qpos[model.joint(joint).qposadr[0]] = position
        mujoco.mj_kinematics(model, data)
        np.testing.assert_allclose(
            links_in_mujoco(model, data, hand), forward_kinematics(hand, q), rtol=0, atol=1e-9
        )
    for link in hand.links[1:]:
        assert model.body(link.name).mass[0] == pytest.approx(link.inertia.mass, rel=1e-9)
    root = ET.fromstring(text)
    mimics = {
        joint.get("name"): joint.find("mimic").attrib
        for joint in root.iter("joint")
        if joint.find("mimic") is not None
    }
    for axis in hand.axes:
        if axis.coupling is None:
            assert axis.name not in mimics
        else:
            assert float(mimics[axis.name]["multiplier"]) == axis.coupling.ratio
            assert float(mimics[axis.name]["offset"]) == axis.coupling.offset
            assert mimics[axis.name]["joint"] == axis.coupling.master
        limits = model.joint(axis.name).range
        np.testing.assert_allclose(limits, [axis.lower, axis.upper], rtol=0, atol=1e-9)


def test_usd_has_the_hand_around_the_object_at_every_time_code(run_path, tmp_path):
    record, task = read_run(run_path / "run.json"), load_task("upholding")
    path = tmp_path / "grasps.usda"
    path.write_text(usd_text([(grasp, task) for grasp in record.grasps], "run.json"))
    stage = Usd.Stage.Open(str(path))
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    mesh = UsdGeom.Mesh.Get(stage, "/World/object")
    np.testing.assert_allclose(mesh.GetPointsAttr().Get(), task.object.mesh.vertices, atol=1e-7)
    links = UsdGeom.Xform.Get(stage, "/World/hand").GetPrim().GetChildren()
    assert len(links) == len(task.hand.links)
    for i, grasp in enumerate(record.grasps):
        q = np.array([grasp.joints[name] for name in task.hand.joint_names])
        R = Rotation.from_quat(np.roll(grasp.object.quaternion, -1)).as_matrix()
        T_palm_object = np.block([[R, np.array(grasp.object.position)[:, None]], [np.zeros(3), np.ones(1)]])
        expected = np.linalg.inv(T_palm_object) @ forward_kinematics(task.hand, q)
        for link, T in zip(links, expected, strict=True):
            found = np.array(UsdGeom.Xformable(link).ComputeLocalToWorldTransform(float(i))).T
            np.testing.assert_allclose(found, T, rtol=0, atol=1e-9)
        hand = stage.GetPrimAtPath("/World/hand")
        assert hand.GetAttribute("grasp").Get(float(i)) == grasp.id
        assert hand.GetAttribute("joint:thumb_flexion").Get(float(i)) == grasp.joints["thumb_flexion"]


def test_without_usd_core_the_extra_is_named(run_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    record, task = read_run(run_path / "run.json"), load_task("upholding")
    with pytest.raises(MissingBackend, match=r"holdfast\[usd\]"):
        usd_text([(record.grasps[0], task)], "run.json")


def test_mjcf_has_every_grasp_as_keyframes(run_path):
    record, task = read_run(run_path / "run.json"), load_task("upholding")
    model = mujoco.MjModel.from_xml_string(
        keyframes_mjcf([(grasp, task) for grasp in record.grasps], "run.json")
    )
    data = mujoco.MjData(model)
    for grasp in record.grasps:
        mujoco.mj_resetDataKeyframe(model, data, model.key(grasp.id).id)
        mujoco.mj_kinematics(model, data)
        q = np.array([grasp.joints[name] for name in task.hand.joint_names])
        np.testing.assert_allclose(
            links_in_mujoco(model, data, task.hand), forward_kinematics(task.hand, q), rtol=0, atol=1e-9
        )
        palm = data.body(task.hand.links[0].name)
        R = palm.xmat.reshape(3, 3)
        np.testing.assert_allclose(
            R.T @ (data.body("object").xpos - palm.xpos), grasp.object.position, rtol=0, atol=1e-9
        )
        zero = model.actuator_biasprm[:, 0] / model.actuator_gainprm[:, 0]  # what controls count from
        squeeze = zero + model.key(f"{grasp.id}/squeeze").ctrl
        np.testing.assert_allclose(
            squeeze, [grasp.hold.squeeze.targets[name] for name in task.hand.independent_names], atol=1e-9
        )
        before = zero + model.key(f"{grasp.id}/pregrasp").ctrl
        waypoint = grasp.approach.waypoints[0]
        np.testing.assert_allclose(
            before, [waypoint[name] for name in task.hand.independent_names], atol=1e-9
        )


def test_mjcf_begins_squeezed_in_the_first_grasp(run_path):
    """Loaded and stepped by a program that asks for no keyframe, the hand keeps what it holds."""
    record, task = read_run(run_path / "run.json"), load_task("upholding")
    text = keyframes_mjcf([(grasp, task) for grasp in record.grasps if grasp.is_held], "run.json")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    best = next(grasp for grasp in record.grasps if grasp.is_held)
    np.testing.assert_allclose(data.body("object").xpos, best.object.position, rtol=0, atol=1e-9)
    model.opt.gravity[:] = [0.0, 0.0, -9.81]
    mujoco.mj_step(model, data, 250)
    assert np.linalg.norm(data.body("object").xpos - best.object.position) < 0.005
