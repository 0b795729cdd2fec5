"""Every layout is read as it is written, and one reading of it gives the poses it was made from."""

import pickle

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.pipeline.formats import hand_in_object, object_factor, read_grasps, said_to_hold

from . import made

MM = {"length": "mm"}


def read(tmp_path, data: bytes, name: str = "grasps.dat"):
    path = tmp_path / name
    path.write_bytes(data)
    return read_grasps(path)


def in_mm() -> np.ndarray:
    T = made.poses()
    T[:, :3, 3] *= 1e3
    return T


def xyzw_rows() -> np.ndarray:
    rows = made.rows()[:, :7]
    return np.concatenate([rows[:, :3], rows[:, 4:7], rows[:, 3:4]], axis=1)


def columns_of_a_scene() -> bytes:
    T, q = made.poses(), made.joints()
    joints = {f"j{k}": q[:, k] for k in reversed(range(q.shape[1]))}
    return made.saved(None, translation=T[:, :3, 3], rotation=T[:, :3, :3], point=T[:, :3, 3] + 1.0, **joints)


# What is written, the format and how many grasps it has, and the answers that differ from the usual ones.
LAYOUTS = {
    "isaac": (made.isaac(), "isaac_grasp", {}),
    "isaac frames": (made.isaac({"object_frame": "/World/mug", "gripper_frame": "/h"}), "isaac_grasp", {}),
    "isaac links": (made.isaac({"object_frame_link": "/World/mug"}), "isaac_grasp", {}),
    "isaac no version": (made.isaac({"format_version": "-"}), "isaac_grasp", {}),
    "isaac text version": (made.isaac({"format_version": "1.0"}), "isaac_grasp", {}),
    "isaac no format": (made.isaac({"format": "-"}), "isaac_grasp", {}),
    "isaac no joints": (
        made.isaac(entry={"cspace_position": {}, "pregrasp_cspace_position": {}}),
        "isaac_grasp",
        {},
    ),
    "graspgen": (made.as_json(made.graspgen()), "graspgen", {}),
    "graspgen numbers": (made.as_json(made.graspgen(object_in_gripper=[1, 0, 1, 0, 1])), "graspgen", {}),
    "graspgen mm": (made.as_json(made.graspgen(transforms=in_mm().tolist())), "graspgen", MM),
    "graspgen columns": (
        made.as_json(made.graspgen(transforms=made.poses().transpose(0, 2, 1).tolist())),
        "graspgen",
        {},
    ),
    "6-DoF GraspNet": (
        made.as_json({"object": "m.obj", "object_scale": 0.2, "transforms": made.poses().tolist()}),
        "graspgen",
        {},
    ),
    "DexGraspNet 2.0": (columns_of_a_scene(), "dexgraspnet", {}),
    "multigripper": (made.as_json(made.multigripper()), "multigrippergrasp", {}),
    "multigripper keyed": (
        made.as_json(
            {key: made.keyed(v) if isinstance(v, list) else v for key, v in made.multigripper().items()}
        ),
        "multigrippergrasp",
        {},
    ),
    "multigripper xyzw": (
        made.as_json(made.multigripper(pose=xyzw_rows().tolist())),
        "multigrippergrasp",
        {"quaternion": "xyzw"},
    ),
    "acronym": (made.acronym(), "acronym", {}),
    "dexgraspnet": (made.saved(made.dexgraspnet()), "dexgraspnet", {}),
    "bench": (made.saved(made.dexgraspbench()), "dexgraspbench", {}),
    "bodex": (
        made.saved(
            {
                "robot_pose": np.stack([made.rows()] * 3, axis=1)[None],
                "joint_names": made.NAMES,
                "scene_path": ["src/scene.npy"],
            }
        ),
        "dexgraspbench",
        {},
    ),
    "simox": (made.simox(), "simox", {}),
    "simox angles": (made.simox(angles=True), "simox", {}),
    "isaac rows": (made.isaac(rows=True), "isaac_grasp", {"quaternion": "wxyz"}),
    "multigripper flat": (
        made.as_json(made.multigripper(pose=np.ravel(made.multigripper()["pose"]).tolist())),
        "multigrippergrasp",
        {},
    ),
    "multigripper by gripper": (
        made.as_json({"a": {k: v for k, v in made.multigripper().items() if k != "gripper"}}),
        "multigrippergrasp",
        {},
    ),
    "hdf5 of others": (made.acronym(names="other/T_grasps"), "acronym", {}),
    "matrices of others": (made.saved(None, my_hands=made.poses(), points=np.zeros((9, 3))), "bare", {}),
    "a dictionary in an archive": (made.saved(None, arr_0=made.dexgraspbench()), "dexgraspbench", {}),
    "billion": (made.saved(made.billion()), "graspnet1billion", {}),
    "bare npy": (made.saved(made.poses()), "bare", {}),
    "bare npz": (made.saved(None, arr_0=made.poses()), "bare", {}),
    "bare float32": (made.saved(made.poses().astype(np.float32)), "bare", {}),
    "bare json": (made.as_json(made.poses().tolist()), "bare", {}),
    "bare text": (
        b"\n".join(b" ".join(b"%r" % float(v) for v in r) for T in made.poses() for r in T),
        "bare",
        {},
    ),
    "bare row": (
        b"# x\n" + b"\n".join(b",".join(b"%r" % float(v) for v in T.ravel()) for T in made.poses()),
        "bare",
        {},
    ),
    "bare quaternions": (made.saved(xyzw_rows()), "bare", {"quaternion": "xyzw"}),
    "bare pickle": (pickle.dumps({"grasps": list(made.poses()), "scores": [0.5] * made.N}, 2), "bare", {}),
    "contact-graspnet": (
        made.saved(
            None,
            pred_grasps_cam={1: made.poses()[:2], 2: made.poses()[2:]},
            scores={1: np.ones(2), 2: np.ones(3)},
        ),
        "bare",
        {},
    ),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_layout_gives_back_the_poses_it_was_made_from(name, tmp_path):
    data, format_, answers = LAYOUTS[name]
    file = read(tmp_path, data)
    assert file.format == format_
    assert len(file.grasps) == made.N
    reading = file.answers(**answers)
    found = np.array([hand_in_object(grasp, reading) for grasp in file.grasps])
    tolerance = 1e-7 if "float32" in name else 1e-9
    np.testing.assert_allclose(found, made.poses(), atol=tolerance)


def test_what_isaac_grasp_says_beside_poses(tmp_path):
    head = {"object_file": "a/mug.obj", "object_scale": 0.5, "bite_point": [0, 0, 0.1], "vendor": {"x": [1]}}
    file = read(tmp_path, made.isaac(head))
    grasp = file.grasps[1]
    assert grasp.grasp.joints.by_name == {"finger_joint": 0.01}
    assert grasp.pregrasp.joints.by_name == {"finger_joint": 0.04}
    assert (grasp.object.path, grasp.object.scale) == ("a/mug.obj", (0.5,))
    assert grasp.hand.numbers == {"bite_point": (0.0, 0.0, 0.1)}
    assert said_to_hold(file) == [False, True, False, True, False]
    assert "quaternion" not in {question.name for question in file.unsettled}
    before = read(tmp_path, made.isaac(entry={"cspace_position": {}}))
    assert "it has joints of the pregrasp alone" in before.remarks


def test_what_yaml_programs_write_twice_is_read(tmp_path):
    shared = {"finger_joint": 0.02}
    data = made.isaac(entry={"cspace_position": shared, "pregrasp_cspace_position": shared})
    assert b"&id001" in data
    assert read(tmp_path, data).grasps[4].grasp.joints.by_name == shared


def test_what_graspgen_says_beside_poses(tmp_path):
    file = read(tmp_path, made.as_json(made.graspgen()))
    assert said_to_hold(file) == [True, False, True, False, True]
    assert file.grasps[2].labels == {"object_in_gripper": True, "score": pytest.approx(0.2)}
    hand = file.hands[0]
    assert (hand.name, hand.path, hand.numbers["width"]) == ("franka_panda", "franka.usd", 0.08)
    assert file.question("quaternion").usual == "xyzw"  # of the offset
    np.testing.assert_allclose(object_factor(file.grasps[0], file.answers()), 0.5)


def test_multigripper_columns_results_and_several_grippers(tmp_path):
    file = read(tmp_path, made.as_json(made.multigripper()))
    assert said_to_hold(file) == [True, False, None, True, False]
    assert file.question("joint_order").answers == ()
    np.testing.assert_allclose(file.grasps[3].grasp.joints.values, made.joints()[3])
    bare = {key: made.multigripper()[key] for key in ("object_id", "pose", "fall_time")}
    file = read(tmp_path, made.as_json({**bare, "final_dofs": made.joints().tolist()}))
    np.testing.assert_allclose(file.grasps[3].grasp.joints.values, made.joints()[3])
    assert "its joints are those at the end of closing, final_dofs" in file.remarks
    several = made.multigripper(
        gripper=["a", "b", "a", "b", "a"], result=[1, 0, 1, 1, 0], object_ID=made.multigripper()["object_id"]
    )
    file = read(tmp_path, made.as_json(several))
    assert {hand.name for hand in file.hands} == {"a", "b"}
    assert said_to_hold(file) == [True, False, True, True, False]
    assert "it holds grasps of 2 grippers" in file.remarks


def test_what_acronym_says_beside_poses(tmp_path):
    file = read(tmp_path, made.acronym())
    grasp = file.grasps[0]
    assert (grasp.object.path, grasp.object.scale, grasp.object.mass) == ("meshes/Mug/x.obj", (0.001,), 0.2)
    assert grasp.hand.name == "panda"
    assert said_to_hold(file) == [True, False, True, False, True]
    two = np.stack([made.poses(), made.poses(3)], axis=1)
    file = read(tmp_path, made.acronym(two))
    assert [grasp.name for grasp in file.grasps[:3]] == ["0/0", "0/1", "1/0"]
    assert said_to_hold(file)[:4] == [True, True, False, False]


def test_dexgraspnet_and_unidexgrasp_differ_in_what_scale_means(tmp_path):
    file = read(tmp_path, made.saved(made.dexgraspnet()), "core-mug.npy")
    assert file.grasps[0].object.name == "core-mug"
    assert file.grasps[2].grasp.joints.by_name["robot0:FFJ4"] == pytest.approx(made.joints()[2, 0])
    np.testing.assert_allclose(object_factor(file.grasps[0], file.answers()), 0.08)
    folder = tmp_path / "sem-Car"
    folder.mkdir()
    one = made.saved(None, qpos=made.dexgraspnet_qpos(0), scale=np.float32(12.5), plane=np.zeros(4))
    file = read(folder, one, "00001.npz")
    assert file.question("scale").usual == "divided"
    assert file.grasps[0].object.name == "sem-Car"
    np.testing.assert_allclose(object_factor(file.grasps[0], file.answers()), 0.08, rtol=1e-6)
    np.testing.assert_allclose(hand_in_object(file.grasps[0], file.answers()), made.poses()[0], atol=1e-9)
    degrees = made.dexgraspnet()
    for entry in degrees:
        entry["qpos"] = {key: v if "T" in key[:4] else np.rad2deg(v) for key, v in entry["qpos"].items()}
    file = read(tmp_path, made.saved(degrees))
    found = hand_in_object(file.grasps[1], file.answers(angle="deg"))
    np.testing.assert_allclose(found, made.poses()[1], atol=1e-9)


def test_dexgraspnet_2_has_a_column_for_each_joint(tmp_path):
    file = read(tmp_path, columns_of_a_scene(), "046.npz")
    assert (file.format, len(file.grasps), file.grasps[0].labels) == ("dexgraspnet", made.N, {})
    for i, grasp in enumerate(file.grasps):
        assert grasp.grasp.joints.names == tuple(f"j{k}" for k in range(len(made.joints()[i])))
        np.testing.assert_allclose(grasp.grasp.joints.values, made.joints()[i])
        np.testing.assert_allclose(hand_in_object(grasp, file.answers()), made.poses()[i], atol=1e-9)
    T = made.poses()
    short = made.saved(None, translation=T[:, :3, 3], rotation=T[:, :3, :3], j0=np.zeros(made.N - 1))
    with pytest.raises(InputError, match="j0: must be"):
        read(tmp_path, short)


def test_matrices_of_an_unknown_name_are_said_to_be_taken(tmp_path):
    file = read(tmp_path, made.saved(None, T_world_hand=made.poses(), index=np.arange(made.N)))
    assert any("T_world_hand, the only matrices" in remark for remark in file.remarks)


def test_what_is_refused_is_described_by_its_fields(tmp_path):
    with pytest.raises(InputError, match="the fields image, depth"):
        read(tmp_path, made.saved({"image": np.zeros((4, 4, 3)), "depth": np.zeros((4, 4))}))


def test_bench_rows_alone_or_many_with_their_moments(tmp_path):
    many = read(tmp_path, made.saved(made.dexgraspbench()))
    one = read(tmp_path, made.saved(made.dexgraspbench(2, succ_flag=True)))
    for file, i in ((many, 2), (one, 0)):
        grasp = file.grasps[i]
        np.testing.assert_allclose(grasp.grasp.joints.values, made.joints()[2])
        np.testing.assert_allclose(grasp.squeeze.joints.values, made.joints()[2] + 0.1)
        np.testing.assert_allclose(grasp.pregrasp.joints.values, made.joints()[2] - 0.1)
        assert (grasp.object.path, grasp.object.scale) == ("assets/object/mug", (0.06,))
    assert said_to_hold(one) == [True]
    moved = np.concatenate([made.poses()[4][:3, 3], made.wxyz(made.poses()[4])])
    file = read(tmp_path, made.saved(made.dexgraspbench(1, obj_pose=moved)))
    np.testing.assert_allclose(
        hand_in_object(file.grasps[0], file.answers()),
        np.linalg.solve(made.poses()[4], made.poses()[1]),
        atol=1e-9,
    )
    joints_alone = made.dexgraspbench(0, grasp_qpos=np.full(22, 0.3))
    del joints_alone["pregrasp_qpos"], joints_alone["squeeze_qpos"]
    file = read(tmp_path, made.saved(joints_alone))
    assert file.grasps[0].grasp.pose is None
    assert len(file.grasps[0].grasp.joints.values) == 22


def test_dexonomy_and_bodex_variants(tmp_path):
    template = {
        "grasp_qpos": made.rows()[:1],
        "tmpl_name": "pinch",
        "hand_cbody": ["ff"],
        "n_evo": np.zeros(1),
    }
    file = read(tmp_path, made.saved(template))
    assert file.variant == "Dexonomy"
    assert "it names no object, as templates do" in file.remarks
    stages = {**template, "pregrasp_qpos": made.rows(), "scene_path": "x", "scene_scale": np.array([0.1])}
    file = read(tmp_path, made.saved(stages))
    np.testing.assert_allclose(file.grasps[0].pregrasp.joints.values, made.joints()[0])
    bodex = {"robot_pose": np.stack([made.rows()] * 3, axis=1)[None], "joint_names": made.NAMES}
    file = read(tmp_path, made.saved(bodex))
    assert file.grasps[0].squeeze.joints.by_name.keys() == set(made.NAMES)
    assert file.question("joint_order") is None


def test_graspit_worlds_pair_hands_with_bodies(tmp_path):
    file = read(tmp_path, made.graspit())
    (grasp,) = file.grasps
    assert (grasp.hand.name, grasp.object.name) == ("Barrett", "mug")
    np.testing.assert_allclose(hand_in_object(grasp, file.answers()), made.poses()[1], atol=1e-9)
    assert len(grasp.grasp.joints.values) == 7


def test_simox_poses_are_of_the_object_and_degrees_are_said(tmp_path):
    for unit in ("radian", "degree"):
        file = read(tmp_path, made.simox(unit))
        grasp = file.grasps[3]
        assert grasp.grasp.joints.by_name == {"Thumb": pytest.approx(0.5)}
        assert (grasp.hand.name, grasp.hand.frame, grasp.object.name) == ("Hand L", "Armar3", "Mug")
        assert grasp.labels == {"quality": 0.3}


def test_names_and_widths_of_arrays(tmp_path):
    file = read(tmp_path, made.saved(made.billion()))
    grasp = file.grasps[2]
    assert (grasp.width, grasp.labels, grasp.object.name) == (0.06, {"score": 0.7}, "2")
    file = read(tmp_path, LAYOUTS["contact-graspnet"][0])
    assert [grasp.name for grasp in file.grasps] == ["1/0", "1/1", "2/0", "2/1", "2/2"]
    assert file.grasps[0].labels == {"scores": 1.0}
    file = read(tmp_path, made.saved(None, poses=made.poses(), width=np.full(made.N, 0.05)))
    assert file.grasps[0].width == 0.05


def test_a_name_ending_says_nothing(tmp_path):
    for name in ("x.npy", "x.yaml", "x", "x.h5"):
        assert read(tmp_path, made.as_json(made.graspgen()), name).format == "graspgen"
