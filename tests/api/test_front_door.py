"""The front door: what `import holdfast as hf` offers, from names, paths, meshes and arrays."""

import json
import subprocess
import sys
import types
from pathlib import Path

import holdfast as hf
import mujoco
import numpy as np
import pytest
import trimesh
from holdfast import api
from holdfast.geometry import BezierPatch, Patch
from holdfast.objects import ObjectModel
from holdfast.solver import SolveResult, Verdict


def face(z: float) -> np.ndarray:
    """Control points (2, 2, 3) of a square of 20 mm at height z whose normal points away from z = 0."""
    s = np.sign(z)
    return np.array([[[x, -0.01 * s, z], [x, 0.01 * s, z]] for x in (-0.01, 0.01)])


FACES = {"index/tip": face(0.01), "thumb/tip": face(-0.01)}


@pytest.fixture(scope="module")
def box() -> trimesh.Trimesh:
    return trimesh.creation.box((0.04, 0.06, 0.02))


@pytest.fixture(scope="module")
def pinch(box: trimesh.Trimesh) -> hf.Task:
    return hf.Task(name="pinch", hand="sa", object=box, contacts=FACES)


@pytest.fixture(scope="module")
def solved(pinch: hf.Task) -> SolveResult:
    return hf.solve(pinch, candidates=3, budget_s=600.0)


@pytest.fixture(scope="module")
def grasp(solved: SolveResult) -> hf.Grasp:
    made = next(filter(None, map(hf.make_grasp, solved)), None)
    assert isinstance(made, hf.Grasp)
    return made


def test_importing_it_loads_nothing_heavy() -> None:
    code = "import sys, holdfast; print(sorted({'numpy', 'numba', 'mujoco', 'trimesh'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_everything_it_lists_is_there_and_nothing_else() -> None:
    for name in hf.__all__:
        assert getattr(hf, name) is not None
    assert sorted([*api.__all__, "__version__"]) == sorted(hf.__all__)
    assert set(hf.__all__) <= set(dir(hf))
    with pytest.raises(AttributeError, match="sovle"):
        hf.sovle  # noqa: B018


def test_a_task_is_made_from_names_paths_meshes_and_arrays(box: trimesh.Trimesh, tmp_path: Path) -> None:
    box.export(tmp_path / "my box.obj")
    objects = (
        box,
        (box.vertices.tolist(), box.faces),
        tmp_path / "my box.obj",
        str(tmp_path / "my box.obj"),
        hf.load_object(box, mass_kg=0.1, friction=0.5),
    )
    for given in objects:
        task = hf.Task(hand="sa", object=given, contacts=FACES)
        assert isinstance(task.object, ObjectModel)
        assert task.object.mesh.volume == pytest.approx(0.04 * 0.06 * 0.02)
        assert [contact.hand.name for contact in task.contacts] == list(FACES)
    by_name = hf.Task(
        hand=hf.load_hand("sa"),
        object="scalpel",
        contacts=[("index/tip", "index_grip"), ("thumb/tip", "thumb_grip")],
    )
    assert [contact.object.name for contact in by_name.contacts] == ["index_grip", "thumb_grip"]
    assert hf.load_task("upholding").contacts[0].object.name == "index_grip"
    assert isinstance(hf.load_task("upholding"), hf.Task)


def test_regions_are_taken_as_values_too(box: trimesh.Trimesh) -> None:
    patches = [Patch(BezierPatch(face(0.01))), BezierPatch(face(-0.01))]
    task = hf.Task(hand="sa", object=box, contacts=zip(FACES, patches, strict=True))
    for contact, net in zip(task.contacts, FACES.values(), strict=True):
        assert isinstance(contact.object.region, Patch)
        np.testing.assert_array_equal(contact.object.region.patch.control_points, net)


def test_a_mesh_weighs_what_is_said_or_what_its_sources_say(box: trimesh.Trimesh) -> None:
    said = hf.load_object(box, mass_kg=0.3, friction=0.4)
    assert (said.inertia.mass, said.friction) == (pytest.approx(0.3), 0.4)
    assert said.sources == {}
    # A box of 40 x 60 x 20 mm: (a^2 + b^2) / 12 about each axis.
    squares = np.array([0.04, 0.06, 0.02]) ** 2
    np.testing.assert_allclose(np.diag(said.inertia.inertia), 0.3 / 12 * (squares.sum() - squares), rtol=1e-9)
    assumed = hf.load_object(box)
    assert assumed.inertia.mass == pytest.approx(500 * box.volume)
    assert set(assumed.sources) == {"mass", "friction"}


def test_the_callers_mesh_is_left_alone(box: trimesh.Trimesh) -> None:
    inverted = trimesh.Trimesh(box.vertices, box.faces[:, ::-1], process=False)
    before = inverted.faces.copy()
    assert hf.load_object(inverted).mesh.volume > 0
    np.testing.assert_array_equal(inverted.faces, before)


def test_joints_are_narrowed_by_name(box: trimesh.Trimesh) -> None:
    task = hf.Task(hand="sa", object=box, contacts=FACES, limits={"index_flexion": (0.1, 0.2)})
    i = task.hand.independent_names.index("index_flexion")
    assert task.limits[i].tolist() == [0.1, 0.2]
    assert np.delete(task.limits, i, 0).tolist() == np.delete(task.hand.limits, i, 0).tolist()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"hand": "sx"}, "Task: hand: unknown hand 'sx'; did you mean 'sa'"),
        ({"object": "scalpell"}, "Task: object: unknown object 'scalpell'; did you mean 'scalpel'"),
        ({"object": 4}, "Task: object: must be a name, a path, a trimesh, or a pair"),
        ({"object": (np.zeros((3, 3)), [[0, 1, 5]])}, "a face names a vertex that does not exist"),
        ({"object": (np.zeros((3, 2)), [[0, 1, 2]])}, "needs vertices"),
        ({"object": "nothing.obj"}, "'nothing.obj': no such file"),
        ({"contacts": {}}, "Task: contacts: needs at least one pair"),
        ({"contacts": "index/tip"}, "Task: contacts: must be pairs"),
        ({"contacts": [("index/tip",)]}, "Task: contacts.0: must be a pair"),
        ({"contacts": {"index/tp": face(0.01)}}, "contacts.0.hand: unknown region of hand sa 'index/tp'"),
        ({"contacts": {"index/tip": "front"}}, "contacts.0.object: unknown region of object"),
        ({"contacts": {"index/tip": np.full((2, 2, 3), np.nan)}}, "contacts.0.object: has control points"),
        ({"contacts": {"index/tip": np.zeros((2, 3))}}, "contacts.0.object: must be a region, or an array"),
        ({"contacts": {"index/tip": np.zeros((2, 2, 3))}}, "contacts.0.object: must be larger"),
        ({"contacts": {3: face(0.01)}}, "contacts.0.hand: must be the name of a region"),
        ({"limits": {"index_flexion": (0.3, 0.2)}}, "limits.index_flexion: the lower limit"),
        ({"limits": {"index_flexion": (float("nan"), 0.2)}}, "limits.index_flexion"),
        ({"limits": {"index_flex": (0.1, 0.2)}}, "limits.index_flex: unknown independent joint"),
        ({"limits": np.zeros((2, 2))}, "Task: limits: must be"),
        ({"T_palm_object": np.eye(3)}, "Task: T_palm_object: must be a pose"),
    ],
)  # fmt: skip
def test_what_can_not_be_a_task_is_named(box: trimesh.Trimesh, change: dict[str, object], words: str) -> None:
    with pytest.raises(hf.InputError) as caught:
        hf.Task(**{"hand": "sa", "object": box, "contacts": FACES, **change})
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "values", [{"mass_kg": float("nan")}, {"mass_kg": -1.0}, {"friction": 0.0}, {"friction": float("inf")}]
)
def test_masses_and_frictions_are_checked(box: trimesh.Trimesh, values: dict[str, float]) -> None:
    with pytest.raises(hf.InputError, match=next(iter(values))):
        hf.load_object(box, **values)
    with pytest.raises(hf.InputError, match="of its own"):
        hf.load_object("scalpel", mass_kg=0.1)


def test_a_grasp_is_made_held_saved_and_loaded_again(grasp: hf.Grasp, tmp_path: Path) -> None:
    assert grasp
    assert grasp.certified
    trial = hf.hold(grasp)
    assert trial.held == trial.result.held
    path = grasp.save(tmp_path / "mine.json", trial)
    written = json.loads(path.read_text("utf-8"))
    assert written["id"] == "mine"
    assert written["joints"] == grasp.joints
    assert written["hold"]["held"] == trial.held
    again = hf.load_configuration(path, grasp.task)
    assert again.certified
    for name, angle in grasp.joints.items():
        assert again.joints[name] == pytest.approx(angle, abs=1e-9)


@pytest.mark.parametrize("name", ["odd name", "-", "ünï", "\u202ex\x1b[2J", "a" * 250])
def test_a_grasp_is_saved_under_any_name(name: str, grasp: hf.Grasp, tmp_path: Path) -> None:
    path = grasp.save(tmp_path / f"{name}.json")
    assert hf.load_configuration(path, grasp.task).certified


def test_saving_replaces_regular_files_alone(grasp: hf.Grasp, tmp_path: Path) -> None:
    (tmp_path / "null.json").symlink_to("/dev/null")
    (tmp_path / "link.json").symlink_to("target.json")
    for name in ("null.json", "link.json"):
        grasp.save(tmp_path / name)
        assert (tmp_path / name).is_symlink()
    assert hf.load_configuration(tmp_path / "target.json", grasp.task).certified
    assert Path("/dev/null").is_char_device()


@pytest.mark.parametrize("path", ["", 3, b"x", "a" * 300, "g\0.json", "/proc/version/x.json", "/"])
def test_a_grasp_that_cannot_be_saved_says_so(path: object, grasp: hf.Grasp) -> None:
    for write in (grasp.save, grasp.to_mjcf):
        with pytest.raises(hf.InputError):
            write(path)  # type: ignore[arg-type]


@pytest.mark.parametrize("path", ["", 3, "a" * 300, "g\0", "/proc/version/x"])
@pytest.mark.parametrize("kind", ["task", "mesh"])
def test_a_run_looks_at_its_folder_beforehand(kind: str, path: object, tmp_path: Path, monkeypatch) -> None:
    # Whatever is begun before the folder has been looked at fails otherwise.
    monkeypatch.setattr("holdfast.pipeline.run.rounds.solve_for_starts", None)
    monkeypatch.setattr("holdfast.pipeline.run_object.request.load_object", None)
    mesh = tmp_path / "thing.stl"
    mesh.write_bytes(b"solid")
    for out in ("out", "save") if kind == "mesh" else ("out",):
        given = {"out": tmp_path / "run", out: path}
        with pytest.raises(hf.InputError):
            hf.run(mesh if kind == "mesh" else "upholding", **given)


def test_the_model_of_a_grasp_has_it_as_its_keyframe(grasp: hf.Grasp, tmp_path: Path) -> None:
    text = grasp.to_mjcf(tmp_path / "mine.xml")
    assert (tmp_path / "mine.xml").read_text("utf-8") == text
    model = mujoco.MjModel.from_xml_string(text)
    key = model.key_qpos[0]
    for name, angle in grasp.joints.items():
        assert key[model.joint(name).qposadr[0]] == pytest.approx(angle, abs=1e-6)


def test_a_refusal_is_false_and_can_not_be_held(solved: SolveResult, monkeypatch: pytest.MonkeyPatch) -> None:
    refusal = hf.make_grasp(solved[0], margin_m=0.5)  # nothing is half a metre from its neighbours
    assert not refusal
    assert "not clear" in str(refusal)
    with pytest.raises(hf.InputError, match="not clear"):
        hf.hold(refusal)
    with pytest.raises(hf.InputError, match="configuration"):
        hf.make_grasp("upholding")
    with pytest.raises(hf.UnknownName, match="preset"):
        hf.make_grasp(solved[0], preset="dexonomi")


def test_roots_are_named_and_proved() -> None:
    found = hf.roots(["x**2 + y**2 - 1", "x - y**3"], x=(-2, 2), y=(-2, 2))
    assert found.verdict is Verdict.COMPLETE
    assert len(found) == 2
    for root in found:
        assert root.certified
        assert root["x"] == pytest.approx(root["y"] ** 3, abs=1e-12)
        assert root["x"] ** 2 + root["y"] ** 2 == pytest.approx(1.0, abs=1e-12)
    assert [root["y"] for root in found[:1]] == [found[0]["y"]]
    assert str(found).startswith("complete: 2 certified solutions")
    assert "<td" in found._repr_html_()
    assert hf.roots("x**2 + 1", x=(-3, 3)).verdict is Verdict.INFEASIBLE


@pytest.mark.parametrize(
    ("equations", "box", "words"),
    [
        (["x + z"], {"x": (0, 1)}, "unknown variable 'z'"),
        (["x"], {"x": 3}, "x: must be an interval"),
        (["x"], {"x": (1, 0)}, "above the upper"),
        (["x"], {"x": (0, float("nan"))}, "variables.x"),
        (["x"], {}, "variables"),
        (["x - x"], {"x": (0, 1)}, "is zero for all values"),
    ],
)
def test_what_is_no_system_is_named(equations: list[str], box: dict[str, object], words: str) -> None:
    with pytest.raises(hf.InputError) as caught:
        hf.roots(equations, **box)
    assert words in str(caught.value)


def test_a_run_of_a_task_built_in_python_gives_rows_and_a_frame(
    pinch: hf.Task, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))
    done = hf.run(pinch, tmp_path / "run", candidates=2, wanted=1, budget_s=600.0)
    assert done.verdict == "held"
    assert done.report.is_file()
    assert len(done) == len(done.rows()) == 2
    assert str(done).startswith("pinch: held; ")
    assert "<table" in done._repr_html_()
    assert done.rows()[0]["joint.index_flexion"] == done[0].joints["index_flexion"]

    class Frame(list):
        def set_index(self, name: str) -> tuple[str, "Frame"]:
            return name, self

    monkeypatch.setitem(sys.modules, "pandas", types.SimpleNamespace(DataFrame=Frame))
    assert done.to_frame() == ("grasp", done.rows())
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(hf.MissingBackend, match="pandas"):
        done.to_frame()


def test_settings_of_a_run_are_checked_by_name(pinch: hf.Task, tmp_path: Path) -> None:
    for settings, words in (
        ({"candidate": 3}, "did you mean 'candidates'"),
        ({"candidates": 0}, "candidates: must be a whole number of at least 1"),
        ({"candidates": 2.5}, "candidates: must be a whole number"),
        ({"workers": -3}, "workers"),
        ({"sigma": float("nan")}, "sigma: must be a finite number"),
    ):
        with pytest.raises(hf.InputError) as caught:
            hf.run(pinch, tmp_path / "run", **settings)
        assert words in str(caught.value)
    assert not (tmp_path / "run").exists()


def test_an_object_without_a_task_gets_suggestions() -> None:
    found = hf.suggest("family:box:3", count=1, budget_s=120.0)
    assert found
    with pytest.raises(hf.InputError, match="contacts"):
        hf.suggest("family:box:3", contacts=1)


def test_a_mesh_runs_to_grasps_of_all_its_tasks(
    box: trimesh.Trimesh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))
    box.export(tmp_path / "box.stl")
    done = hf.run(tmp_path / "box.stl", tmp_path / "run", mass_kg=0.1, contacts=2, candidates=1, wanted=1)
    assert isinstance(done, hf.MeshRun)
    assert done.verdict == "held"
    assert done.good == [grasp for run in done.runs for grasp in run.good]
    assert len(done.rows()) == len(done)
    assert done.report == tmp_path / "run" / "report.html"
    again = hf.load_task(done.outcome.attempts[0].task)
    assert again.object.inertia.mass == pytest.approx(0.1)


def test_what_goes_with_a_mesh_does_not_go_with_a_task(tmp_path: Path) -> None:
    with pytest.raises(hf.InputError, match="mass_kg: goes with a mesh"):
        hf.run("upholding", tmp_path, mass_kg=0.1)
    with pytest.raises(hf.InputError, match="contacts: must be a whole number of at least 2"):
        hf.run(tmp_path / "box.stl", tmp_path, contacts=1)


def test_a_hand_is_named_and_grasps_are_several(tmp_path: Path, grasp: hf.Grasp) -> None:
    with pytest.raises(hf.InputError, match="run: hand: must be the name of a built-in hand, or a path"):
        hf.run("upholding", tmp_path, hand=hf.load_hand("sa"))
    with pytest.raises(hf.InputError, match="grasps: must be grasps"):
        hf.hold_many(5)
    # One that is refused is found in a generator as in a list.
    with pytest.raises(hf.InputError, match=r"grasps\.1: must be a grasp"):
        hf.hold_many(one for one in (grasp, None))
