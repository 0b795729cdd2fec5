"""`holdfast export`: files of other formats from a run, from grasps, and from other programs' files."""

import json

import mujoco
import numpy as np
import pytest
import trimesh
from holdfast.objects import load_object
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.formats import hand_in_object, read_grasps


def export(*words) -> int:
    return main(["export", *map(str, words), "--quiet"])


def poses(path) -> np.ndarray:
    file = read_grasps(path)
    return np.array([hand_in_object(grasp, file.answers()) for grasp in file.grasps])


@pytest.fixture(scope="module")
def truth(run_path):
    return poses(run_path / "run.json")


@pytest.mark.parametrize(
    "format_", ["isaac_grasp", "graspgen", "acronym", "dexgraspnet", "multigrippergrasp", "bare"]
)
def test_a_run_in_one_file_and_from_there_into_another(format_, run_path, truth, tmp_path, capsys):
    out = tmp_path / "out"
    assert export(run_path, "--format", format_, "--out", out) == 0
    assert capsys.readouterr().out == f"{out}\n"
    np.testing.assert_allclose(poses(out), truth, rtol=0, atol=1e-9)
    again = tmp_path / "again"
    words = ("--reading", "frame=base") if format_ == "bare" else ()
    assert export(out, "--format", "graspgen", "--out", again, *words) == 0
    np.testing.assert_allclose(poses(again), truth, rtol=0, atol=1e-9)


def test_dexgraspbench_is_a_file_a_grasp(run_path, grasp_path, truth, tmp_path):
    assert export(run_path, "--format", "dexgraspbench", "--out", tmp_path / "many") == 0
    files = sorted((tmp_path / "many").iterdir())
    assert [file.name for file in files] == [f"{i}.npy" for i in range(len(truth))]
    np.testing.assert_allclose(np.concatenate([poses(file) for file in files]), truth, rtol=0, atol=1e-9)
    assert export(grasp_path, "--format", "dexgraspbench", "--out", tmp_path / "one.npy") == 0
    np.testing.assert_allclose(poses(tmp_path / "one.npy"), truth[:1], rtol=0, atol=1e-9)


def test_models_of_hand_and_object(run_path, grasp_path, tmp_path):
    out = tmp_path / "grasps.xml"
    assert export(run_path, "--format", "mjcf", "--out", out, "--mesh", tmp_path / "scalpel.obj") == 0
    assert mujoco.MjModel.from_xml_path(str(out)).nkey >= 3
    found, known = trimesh.load(tmp_path / "scalpel.obj").extents, load_object("scalpel").mesh.extents
    np.testing.assert_allclose(found, known, atol=1e-7)
    assert export(run_path, "--format", "usd", "--out", tmp_path / "grasps.usda") == 0
    assert (tmp_path / "grasps.usda").read_text().startswith("#usda 1.0")
    assert export(grasp_path, "--format", "urdf", "--out", tmp_path / "hand") == 0
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "hand" / "sa.urdf")).njnt == 17


def test_a_mesh_is_named_in_the_export(grasp_path, tmp_path):
    mesh, out = tmp_path / "it.obj", tmp_path / "out.json"
    assert export(grasp_path, "--format", "graspgen", "--out", out, "--mesh", mesh) == 0
    assert json.loads(out.read_text())["object"] == {"file": str(mesh), "scale": 1.0}


def test_what_a_file_leaves_open_is_asked_for(tmp_path, truth, capsys):
    source, out = tmp_path / "bare.npy", tmp_path / "out"
    np.save(source, truth)
    assert export(source, "--format", "graspgen", "--out", out) == 2
    assert "frame: is open: say by --reading whether it is base or tcp" in capsys.readouterr().err
    assert not out.exists()
    assert export(source, "--format", "graspgen", "--out", out, "--reading", "frame=base") == 0
    np.testing.assert_allclose(poses(out), truth, rtol=0, atol=1e-9)
    words = ("--reading", "frame=base", "--reading", "length=mm")
    assert export(source, "--format", "graspgen", "--out", out, *words) == 0
    np.testing.assert_allclose(poses(out)[:, :3, 3], 1e-3 * truth[:, :3, 3], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ("RUN", "--format", "isaac_grsp", "--out", "x"),
            "unknown format 'isaac_grsp'; did you mean 'isaac_grasp'?",
        ),
        (("RUN", "--format", "graspgen", "--out", ""), "not an empty one"),
        (
            ("RUN", "--format", "graspgen", "--out", "x", "--reading", "frame=base"),
            "for files of other programs",
        ),
        (("nothing", "--format", "graspgen", "--out", "x"), "nothing: no such file"),
        ((".", "--format", "graspgen", "--out", "x"), ".: is not a run folder: there is no run.json in it"),
        (("bare.npy", "--format", "mjcf", "--out", "x"), "needs grasps of Holdfast"),
        (("bare.npy", "--format", "graspgen", "--out", "x", "--mesh", "m.obj"), "needs grasps of Holdfast"),
        (
            ("bare.npy", "--format", "graspgen", "--out", "x", "--reading", "order=1"),
            "unknown question 'order'",
        ),
        (("bare.npy", "--format", "graspgen", "--out", "x", "--reading", "frame=t"), "unknown answer 't'"),
        (("RUN", "RUN", "--format", "mjcf", "--out", "x"), "two grasps have the same id"),
    ],
)
def test_misuse_costs_one_line(words, said, run_path, truth, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.save("bare.npy", truth)
    assert export(*(run_path if word == "RUN" else word for word in words)) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (tmp_path / "x").exists()


def test_runs_of_one_object_go_into_one_file(run_path, truth, tmp_path):
    assert export(run_path, run_path, "--format", "acronym", "--out", tmp_path / "x.h5") == 0
    np.testing.assert_allclose(poses(tmp_path / "x.h5"), np.concatenate([truth, truth]), rtol=0, atol=1e-9)
