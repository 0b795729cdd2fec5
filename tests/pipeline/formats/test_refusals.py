"""What can't be read is refused in one line: the file, the field and what is allowed."""

import io
import pickle
import zipfile

import h5py
import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.pipeline.formats import read_grasps

from . import made


def refused(tmp_path, data: bytes, field: str, words: str) -> InputError:
    path = tmp_path / "grasps.dat"
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_grasps(path)
    assert caught.value.source == str(path)
    assert caught.value.field == field
    assert words in caught.value.allowed, caught.value.allowed
    return caught.value


def graspgen(**more) -> bytes:
    return made.as_json(made.graspgen(**more))


def bench(**more) -> bytes:
    return made.saved(made.dexgraspbench(**more))


def matrices(**at) -> list:
    """Poses whose element at a place is another, such as `i0_0_3=...`."""
    T = made.poses()
    for place, value in at.items():
        T[tuple(map(int, place[1:].split("_")))] = value
    return T.tolist()


@pytest.mark.parametrize(
    "data, field, words",
    [
        (b"", "", "no grasps that are known"),
        (b"hello there, grasps", "", "mapping"),
        (b"<robot/>", "", "no grasps that are known"),
        (b"{}", "", "no grasps that are known"),
        (b'{"grasps": ', "line 1", "not valid JSON"),
        (b"\x93NUMPY\x01\x00", "", "damaged"),
        (b"PK\x03\x04abc", "", "archive"),
        (b"\x89HDF\r\n\x1a\nabc", "", "damaged HDF5"),
        (b"1 2 3\n4 5\n", "", "lines of different numbers"),
        (b"1 2 3\n4 5 e\n", "", "numbers alone"),
        (graspgen(transforms=matrices(i2_0_3=np.nan)), "grasps.transforms", "finite"),
        (graspgen(transforms=matrices(i2_0_3=1e12)), "grasps.transforms", "finite"),
        (graspgen(transforms=matrices(i2_0_0=5.0)), "grasps.transforms.2", "rotation"),
        (graspgen(transforms=(made.poses() * [-1.0, 1, 1, 1]).tolist()), "grasps.transforms.0", "rotation"),
        (graspgen(transforms=matrices(i1_3_3=2.0)), "grasps.transforms", "last row"),
        (graspgen(transforms=[[1, 2], [3]]), "grasps.transforms", "shape (N, 4, 4)"),
        (graspgen(transforms=[]), "grasps.transforms", "shape (N, 4, 4)"),
        (graspgen(transforms="x"), "grasps.transforms", "not text 'x'"),
        (graspgen(object_in_gripper=[True]), "grasps.object_in_gripper", "5 values"),
        (made.as_json({**made.graspgen(), "object": {"file": "x", "scale": 0}}), "object.scale", "above 0"),
        (made.as_json({**made.graspgen(), "object": {"file": ["x"]}}), "object.file", "text"),
        (made.isaac(entry={"position": [1, 2]}), "grasps.grasp_0.position", "shape (3,)"),
        (made.isaac(entry={"orientation": "up"}), "grasps.grasp_0.orientation", "{w: ..., xyz"),
        (
            made.isaac(entry={"orientation": {"w": 5.0, "xyz": [0, 0, 0]}}),
            "grasps.grasp_0.orientation.0",
            "length 1",
        ),
        (made.isaac(entry={"cspace_position": {"a": "x"}}), "grasps.grasp_0.cspace_position.a", "a number"),
        (made.isaac(entry={"confidence": "high"}), "grasps.grasp_0.confidence", "a number"),
        (made.isaac().replace(b"grasps:", b"grasp:"), "grasps", "did you mean 'grasp'"),
        (made.isaac(count=1).replace(b"xyz", b"x"), "grasps.grasp_0.orientation.xyz", "required"),
        (b"grasps: &a [*a]", "line 1", "aliases"),
        (b"grasps: &a [1]\nb: &b [*a, *a]\nc: [*b, *b]", "line 2", "aliases"),
        (b"format: isaac_grasp\ngrasps: !!python/object/apply:os.system [x]", "line 2", "tags"),
        (made.as_json(made.multigripper(dofs=[[1.0]])), "dofs", "5 rows"),
        (made.as_json(made.multigripper(pose=made.keyed([[0.0] * 7]))), "pose.0", "length 1"),
        (made.as_json(made.multigripper(pose=[[0.0] * 6] * 5)), "pose", "shape (N, 7)"),
        (made.acronym(np.zeros((3, 4))), "grasps/transforms", "shape (N, 4, 4)"),
        (made.saved([{"qpos": {"WRJTx": 1.0}, "scale": 1.0}]), "0.qpos.WRJTy", "required"),
        (made.saved([{"qpos": {"a": None}, "scale": 1.0}]), "0.qpos.a", "a number"),
        (made.saved([*made.dexgraspnet(), 5]), "5", "dictionary"),
        (bench(obj_scale=-1.0), "obj_scale", "above 0"),
        (bench(obj_pose=np.zeros(5)), "obj_pose", "position and a quaternion"),
        (bench(squeeze_qpos=np.zeros((5, 3))), "squeeze_qpos", "numbers a row"),
        (bench(grasp_qpos=np.full((5, 12), np.inf)), "grasp_qpos", "finite"),
        (bench(joint_names=["a"]), "joint_names", "5 names"),
        (made.graspit().replace(b"graspableBody", b"obstacle"), "world.graspableBody", "required"),
        (made.graspit().replace(b"[", b"{"), "robot.1.transform.fullTransform", "(w x y z)[x y z]"),
        (made.simox("furlong"), "GraspSet.0.Grasp.0.Configuration", "radian"),
        (made.simox().replace(b"row2", b"row9"), "GraspSet.0.Grasp.0.Transform.Matrix4x4", "row1 to row4"),
        (made.simox().replace(b"value='0.5'", b"value='x'"), "GraspSet.0.Grasp.0.Configuration", "numbers"),
        (made.saved(np.zeros((4, 17))), "rotation.0", "rotation"),
        (made.saved(np.zeros((4, 5))), "", "no grasps that are known"),
        (made.saved(np.full((4, 7), 9.0)), "0", "length 1"),
        (made.saved(made.poses() * 2.0), "", "last row"),
        (made.saved(np.zeros(3, dtype="f4,f4")), "", "records"),
        (made.saved(made.poses() * 1j), "", "records or of other things"),
        (made.saved(None, poses=np.zeros((0, 4, 4))), "", "holds no grasps"),
    ],
)
def test_wrong_content_is_named(tmp_path, data, field, words):
    refused(tmp_path, data, field, words)


def test_entities_of_xml_are_not_expanded(tmp_path):
    bomb = b'<!DOCTYPE w [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]><world>&b;</world>'
    refused(tmp_path, bomb, "", "document type or entities")


def test_foreign_pickles_are_refused_by_name(tmp_path):
    data = b"ctorch._utils\n_rebuild_tensor_v2\n(tR."
    refused(tmp_path, b"\x80\x02" + data, "", "torch._utils._rebuild_tensor_v2")
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as file:
        file.writestr("archive/data.pkl", data)
    refused(tmp_path, archive.getvalue(), "", "PyTorch")
    inside = made.saved([{"qpos": 1}]).partition(b"\n")[0] + b"\n" + pickle.dumps({1j})
    refused(tmp_path, inside, "", "a pickle that")


def test_claims_of_size_are_not_believed(tmp_path, monkeypatch):
    big = made.saved(np.zeros((1, 4, 4))).replace(b"(1, 4, 4)", b"(9, 4, 4)")
    refused(tmp_path, big, "", "not as large as it says")
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("a.npy", bytes(2 * 1024 * 1024))
    monkeypatch.setattr("holdfast.pipeline.formats.reading._LARGEST_BYTES", 1024 * 1024)
    refused(tmp_path, bomb.getvalue(), "", "too large")
    packed = io.BytesIO()
    with h5py.File(packed, "w") as file:
        file.create_dataset("grasps/transforms", (10**8, 4, 4), "f8", chunks=(1000, 4, 4), compression="gzip")
    refused(tmp_path, packed.getvalue(), "grasps/transforms", "larger than")


def test_a_list_of_the_same_list_is_not_multiplied(tmp_path):
    nest: list = [0.0] * 1000
    for _ in range(12):
        nest = [nest] * 1000
    refused(tmp_path, pickle.dumps({"grasps": nest}), "", "no grasps that are known")
    refused(tmp_path, pickle.dumps({"grasp_qpos": nest}), "grasp_qpos", "shape (N, N)")
    refused(tmp_path, pickle.dumps({"robot_pose": nest}), "robot_pose", "shape (N, N, N)")


def test_other_files_are_not_opened_through_hdf5(tmp_path):
    secret = tmp_path / "secret.bin"
    secret.write_bytes(bytes(128))
    for make in (
        lambda file: file.__setitem__("grasps/transforms", h5py.ExternalLink(str(secret), "/x")),
        lambda file: file.__setitem__("grasps/transforms", h5py.SoftLink("/object")),
        lambda file: file.create_dataset("grasps/transforms", (1, 4, 4), "f8", external=str(secret)),
    ):
        path = tmp_path / "link.h5"
        with h5py.File(path, "w") as file:
            make(file)
        error = refused(tmp_path, path.read_bytes(), "grasps/transforms", "not ")
        assert "link" in error.allowed or "other files" in error.allowed


def test_a_group_that_holds_itself_ends(tmp_path):
    path = tmp_path / "round.h5"
    with h5py.File(path, "w") as file:
        file["a/b"] = file["/"]
    refused(tmp_path, path.read_bytes(), "", "levels of groups")


def test_without_h5py_the_extra_is_named(tmp_path, monkeypatch):
    from holdfast.errors import MissingBackend

    path = tmp_path / "x.h5"
    path.write_bytes(made.acronym())
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(MissingBackend, match=r"holdfast\[formats\]"):
        read_grasps(path)
