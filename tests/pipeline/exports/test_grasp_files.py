"""Exports are read back, to 1e-9, by the formats' own means and by our readers."""

import io
import json
from dataclasses import replace

import h5py
import numpy as np
import pytest
import yaml
from holdfast.errors import InputError, MissingBackend
from holdfast.hands import load_hand
from holdfast.pipeline.exports import (
    GRASP_FORMATS,
    acronym_bytes,
    bare_bytes,
    dexgraspbench_bytes,
    dexgraspnet_bytes,
    grasp_files,
    graspgen_bytes,
    isaac_grasp_bytes,
    multigripper_bytes,
    placed_grasps,
    placed_records,
)
from holdfast.pipeline.exports.angles import roll_pitch_yaw
from holdfast.pipeline.formats import hand_in_object, read_grasps, said_to_hold
from holdfast.pipeline.records import read_run
from scipy.spatial.transform import Rotation

CLOSE = {"rtol": 0, "atol": 1e-9}


@pytest.fixture(scope="module")
def written(run_path):
    """What run.json says, read as plain JSON."""
    return json.loads((run_path / "run.json").read_text())["grasps"]


@pytest.fixture(scope="module")
def grasps(run_path):
    return placed_records(read_run(run_path / "run.json").grasps, load_hand("sa"), "scalpel")


def truth(entry: dict) -> np.ndarray:
    """The palm in the object's frame, by scipy from the written pose of the object in the palm's."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_quat(np.roll(entry["object"]["quaternion"], -1)).as_matrix()
    T[:3, 3] = entry["object"]["position"]
    return np.linalg.inv(T)


def read_back(tmp_path, data: bytes):
    path = tmp_path / "export"
    path.write_bytes(data)
    return read_grasps(path)


def same_poses(file, written) -> None:
    found = [hand_in_object(grasp, file.answers()) for grasp in file.grasps]
    np.testing.assert_allclose(found, [truth(entry) for entry in written], **CLOSE)


def same_joints(found: dict, expected: dict) -> None:
    assert set(found) >= set(expected)
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, abs=1e-9)


def test_isaac_grasp(tmp_path, grasps, written):
    data = isaac_grasp_bytes(grasps)
    plain = yaml.safe_load(data)
    assert plain["format"] == "isaac_grasp"
    for entry, grasp in zip(written, plain["grasps"].values(), strict=True):
        q = [*grasp["orientation"]["xyz"], grasp["orientation"]["w"]]
        np.testing.assert_allclose(Rotation.from_quat(q).as_matrix(), truth(entry)[:3, :3], **CLOSE)
        np.testing.assert_allclose(grasp["position"], truth(entry)[:3, 3], **CLOSE)
        same_joints(grasp["cspace_position"], entry["joints"])
        same_joints(grasp["pregrasp_cspace_position"], entry["approach"]["waypoints"][0])
        assert grasp["confidence"] == float(entry["hold"]["held"])
    file = read_back(tmp_path, data)
    same_poses(file, written)
    same_joints(file.grasps[0].grasp.joints.by_name, written[0]["joints"])


def test_graspgen(tmp_path, grasps, written):
    data = graspgen_bytes(grasps)
    plain = json.loads(data)
    # As GraspGen's documents show how to load one.
    transforms = np.array(plain["grasps"]["transforms"])
    mask = np.array(plain["grasps"]["object_in_gripper"])
    np.testing.assert_allclose(transforms, [truth(entry) for entry in written], **CLOSE)
    assert mask.tolist() == [entry["hold"]["held"] for entry in written]
    assert len(transforms[mask]) == sum(mask)
    file = read_back(tmp_path, data)
    same_poses(file, written)
    same_joints(file.grasps[1].grasp.joints.by_name, written[1]["joints"])


def test_acronym(tmp_path, grasps, written):
    data = acronym_bytes(grasps)
    with h5py.File(io.BytesIO(data)) as plain:
        T = np.array(plain["grasps/transforms"])
        success = np.array(plain["grasps/qualities/flex/object_in_gripper"])
        assert plain["object/scale"][()] == 1.0
    np.testing.assert_allclose(T, [truth(entry) for entry in written], **CLOSE)
    assert success.tolist() == [int(entry["hold"]["held"]) for entry in written]
    assert data == acronym_bytes(grasps), "equal grasps make equal files"
    file = read_back(tmp_path, data)
    same_poses(file, written)
    same_joints(file.grasps[2].grasp.joints.by_name, written[2]["joints"])


def test_dexgraspbench(tmp_path, grasps, written):
    for grasp, entry in zip(grasps, written, strict=True):
        data = dexgraspbench_bytes(grasp)
        plain = np.load(io.BytesIO(data), allow_pickle=True).item()
        row = plain["grasp_qpos"]
        np.testing.assert_allclose(row[:3], truth(entry)[:3, 3], **CLOSE)
        R = Rotation.from_quat(np.roll(row[3:7], -1)).as_matrix()
        np.testing.assert_allclose(R, truth(entry)[:3, :3], **CLOSE)
        names = plain["joint_names"]
        same_joints(dict(zip(names, row[7:], strict=True)), entry["joints"])
        same_joints(
            dict(zip(names, plain["squeeze_qpos"][7:], strict=True)), entry["hold"]["squeeze"]["targets"]
        )
        same_joints(
            dict(zip(names, plain["pregrasp_qpos"][7:], strict=True)), entry["approach"]["waypoints"][0]
        )
        file = read_back(tmp_path, data)
        same_poses(file, [entry])
        same_joints(file.grasps[0].grasp.joints.by_name, entry["joints"])
        assert (file.hands[0].name, file.objects[0].path) == ("sa", "scalpel")


def test_dexgraspnet(tmp_path, grasps, written):
    data = dexgraspnet_bytes(grasps)
    for entry, plain in zip(written, np.load(io.BytesIO(data), allow_pickle=True), strict=True):
        qpos = plain["qpos"]
        # As DexGraspNet poses its hand: Euler angles about fixed axes, then the shift.
        R = Rotation.from_euler("xyz", [qpos[name] for name in ("WRJRx", "WRJRy", "WRJRz")]).as_matrix()
        np.testing.assert_allclose(R, truth(entry)[:3, :3], **CLOSE)
        shift = [qpos[name] for name in ("WRJTx", "WRJTy", "WRJTz")]
        np.testing.assert_allclose(shift, truth(entry)[:3, 3], **CLOSE)
        same_joints(qpos, entry["joints"])
        assert plain["scale"] == 1.0
    file = read_back(tmp_path, data)
    same_poses(file, written)
    assert said_to_hold(file) == [entry["hold"]["held"] for entry in written]


def test_multigripper(tmp_path, grasps, written):
    data = multigripper_bytes(grasps)
    plain = json.loads(data)
    for entry, row, joints in zip(written, plain["pose"], plain["dofs"], strict=True):
        np.testing.assert_allclose(row[:3], truth(entry)[:3, 3], **CLOSE)
        R = Rotation.from_quat(np.roll(row[3:], -1)).as_matrix()
        np.testing.assert_allclose(R, truth(entry)[:3, :3], **CLOSE)
        same_joints(dict(zip(plain["dof_names"], joints, strict=True)), entry["joints"])
    assert plain["result"] == [int(entry["hold"]["held"]) for entry in written]
    file = read_back(tmp_path, data)
    same_poses(file, written)
    same_joints(file.grasps[0].grasp.joints.by_name, written[0]["joints"])
    with pytest.raises(InputError, match="no place for the scale"):
        multigripper_bytes([replace(grasps[0], scale=0.5)])


def test_bare(tmp_path, grasps, written):
    data = bare_bytes(grasps)
    T = np.load(io.BytesIO(data), allow_pickle=False)
    np.testing.assert_allclose(T, [truth(entry) for entry in written], **CLOSE)
    same_poses(read_back(tmp_path, data), written)


@pytest.mark.parametrize("pitch", [0.3, np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-9, 1.5707])
def test_angles_give_their_rotation_also_where_two_axes_are_one(pitch):
    R = Rotation.from_euler("xyz", [0.7, pitch, -2.1]).as_matrix()
    found = Rotation.from_euler("xyz", roll_pitch_yaw(R)).as_matrix()
    np.testing.assert_allclose(found, R, rtol=0, atol=1e-12)


def test_our_own_files_are_read_as_others_are(run_path, written):
    run = read_grasps(run_path / "run.json")
    assert run.variant == "run"
    same_poses(run, written)
    one = read_grasps(run_path / "grasps" / f"{written[0]['id']}.json")
    same_poses(one, written[:1])
    grasp = one.grasps[0]
    same_joints(grasp.squeeze.joints.by_name, written[0]["hold"]["squeeze"]["targets"])
    assert (grasp.hand.name, grasp.object.name) == ("sa", "scalpel")
    assert grasp.labels["certified"] is True
    assert one.unsettled == ()


def test_what_was_read_goes_out_in_another_format(tmp_path, grasps, written):
    file = read_back(tmp_path, graspgen_bytes(grasps))
    again = placed_grasps(file, file.answers())
    file = read_back(tmp_path, isaac_grasp_bytes(again))
    same_poses(file, written)
    same_joints(file.grasps[0].grasp.joints.by_name, written[0]["joints"])
    path = tmp_path / "bare.npy"
    np.save(path, np.array([truth(entry) for entry in written]))
    bare = read_grasps(path)
    with pytest.raises(InputError, match="frame: is open"):
        placed_grasps(bare, bare.answers())
    same_poses(read_back(tmp_path, acronym_bytes(placed_grasps(bare, bare.answers(frame="base")))), written)


def test_one_object_a_file(grasps):
    with pytest.raises(InputError, match="the grasps have 2"):
        graspgen_bytes([grasps[0], replace(grasps[1], object="teapot")])
    with pytest.raises(InputError, match="no grasps"):
        isaac_grasp_bytes([])
    with pytest.raises(InputError, match="no joints"):
        dexgraspbench_bytes(replace(grasps[0], joints={}))


def test_without_h5py_the_extra_is_named(grasps, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(MissingBackend, match=r"holdfast\[formats\]"):
        acronym_bytes(grasps)


@pytest.mark.parametrize("format_", GRASP_FORMATS)
def test_every_format_is_written_by_its_name_and_read_back_under_it(format_, tmp_path, grasps, written):
    files = grasp_files(grasps, format_, tmp_path / "out")
    assert len(files) == (len(grasps) if format_ == "dexgraspbench" else 1)
    found = [read_back(tmp_path, data) for data in files.values()]
    assert {file.format for file in found} == {format_}
    poses = [hand_in_object(g, file.answers(frame="base")) for file in found for g in file.grasps]
    np.testing.assert_allclose(poses, [truth(entry) for entry in written], **CLOSE)
