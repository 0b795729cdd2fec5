"""A mesh alone becomes files, tasks and held grasps; where it does not, it is said what refused."""

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path

import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.objects import load_object, load_task
from holdfast.pipeline.run import RunSettings
from holdfast.pipeline.run_object import GraspRequest, ObjectFiles, ObjectRun, run_object
from holdfast.pipeline.suggest import Suggestion, Tried, searches

SETTINGS = RunSettings(candidates=3, wanted=1, budget_s=600.0)


@pytest.fixture(autouse=True)
def _without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))


@pytest.fixture
def block(tmp_path: Path) -> Path:
    """A mesh file whose name is one that models reserve, with a blank in the folder's."""
    path = tmp_path / "my meshes" / "object.stl"
    path.parent.mkdir()
    trimesh.creation.box((0.05, 0.05, 0.02)).export(path)
    return path


def test_a_mesh_ends_in_held_grasps_and_leaves_files_to_edit(block: Path, tmp_path: Path) -> None:
    source = GraspRequest(str(block), mass_kg=0.12, friction=0.5)
    done = run_object(source, tmp_path / "run", SETTINGS)
    assert done.is_held
    assert "held" in str(done)
    assert (tmp_path / "run" / "report.html").is_file()
    obj = load_object(done.folder / "object.yaml")
    assert (obj.inertia.mass, obj.friction) == (pytest.approx(0.12), 0.5)
    task = load_task(done.attempts[-1].task)
    assert task.name == done.attempts[-1].record.task
    assert len(task.contacts) == 2
    assert block.read_bytes() == (done.folder / "object.stl").read_bytes()


@pytest.mark.slow
def test_the_same_seed_tries_the_same(block: Path, tmp_path: Path) -> None:
    few = replace(SETTINGS, candidates=1)
    runs = [
        run_object(GraspRequest(str(block)), tmp_path / name, few, save=tmp_path / f"{name} files")
        for name in "ab"
    ]
    texts = [[attempt.task.read_text("utf-8") for attempt in done.attempts] for done in runs]
    assert texts[0] == texts[1]
    joints = [[grasp.joints for grasp in done.attempts[-1].record.grasps] for done in runs]
    assert joints[0] == joints[1]


def after(calls: int) -> Callable[[], bool]:
    """Asks to stop after so many questions, so that no clock decides."""
    asked = count()
    return lambda: next(asked) >= calls


def test_what_is_too_large_for_the_hand_gets_a_reason(tmp_path: Path) -> None:
    path = tmp_path / "crate.obj"
    trimesh.creation.box((0.5, 0.5, 0.5)).export(path)
    done = run_object(GraspRequest(str(path)), tmp_path / "run", SETTINGS, should_stop=after(12))
    assert not done.is_held
    assert "try" in str(done)


@pytest.mark.slow
def test_a_heavy_object_is_said_to_be_heavy(block: Path, tmp_path: Path) -> None:
    source = GraspRequest(str(block), mass_kg=60.0, contacts=2)
    done = run_object(source, tmp_path / "run", SETTINGS, should_stop=after(12))
    assert not done.is_held
    assert "--mass" in str(done)


def test_a_run_that_looked_at_nothing_says_so() -> None:
    assert (
        str(ObjectRun((), (), Path())) == "nothing held; nothing was looked at in time: try a larger --budget"
    )


def test_no_attempt_is_no_hold() -> None:
    nothing = ObjectRun((), (Tried(2, sites=96, combinations=3, tasks=9, sinking=7, unreached=2),), Path())
    assert not nothing.is_held
    assert nothing.best is None
    for words in ("96 places", "3 combinations", "9 tried", "7 sink in", "2 not reached", "--contacts"):
        assert words in str(nothing)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"object": "nothing.obj"}, "nothing.obj"),
        ({"object": "nothing"}, "unknown object 'nothing'"),
        ({"hand": "sx"}, "unknown hand 'sx'"),
        ({"mass_kg": -1.0}, "mass_kg"),
        ({"friction": float("nan")}, "friction"),
        ({"contacts": 40}, "contacts"),
    ],
)
def test_what_can_not_be_used_is_named(
    block: Path, tmp_path: Path, change: dict[str, object], words: str
) -> None:
    with pytest.raises(InputError) as caught:
        run_object(replace(GraspRequest(str(block)), **change), tmp_path / "run", SETTINGS)
    assert words in str(caught.value)
    assert not (tmp_path / "run").exists()


def test_files_that_were_edited_are_left_alone_unless_forced(
    block: Path, tmp_path: Path, suggestion: Suggestion
) -> None:
    folder = tmp_path / "files"
    first = ObjectFiles(GraspRequest(str(block)), folder).write_task(suggestion, 1)
    again = ObjectFiles(GraspRequest(str(block)), folder).write_task(suggestion, 1)
    assert again == first
    edited = first.read_text("utf-8") + "# mine\n"
    first.write_text(edited, "utf-8")
    beside = ObjectFiles(GraspRequest(str(block)), folder).write_task(suggestion, 1)
    assert beside != first and load_task(beside).name != load_task(first).name
    assert first.read_text("utf-8") == edited
    (folder / "object.yaml").write_text("name: mine\n", "utf-8")
    with pytest.raises(InputError, match=r"object\.yaml.*another folder"):
        ObjectFiles(GraspRequest(str(block)), folder)
    ObjectFiles(GraspRequest(str(block)), folder, force=True).write_task(suggestion, 1)
    assert first.read_text("utf-8") != edited


def test_task_files_name_an_object_file_where_they_can_and_a_copy_where_not(
    block: Path, tmp_path: Path, suggestion: Suggestion, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = block.with_name("cube.yaml")
    own.write_text(
        f"{{friction: 0.7, parts: {{body: {{mass: 0.1, mesh: {block.name}}}, "
        "base: {mass: 0.2, box: {half_extents: [0.02, 0.02, 0.03]}}}}",
        "utf-8",
    )
    folder = tmp_path / "files"
    for current, is_copied in ((tmp_path, False), (block.parent, True)):
        monkeypatch.chdir(current)
        files = ObjectFiles(GraspRequest(str(own)), folder)
        assert files.object.name == "cube"
        task = load_task(files.write_task(suggestion, 1))
        assert [part.name for part in task.object.parts] == ["body", "base"]
        copies = {path.name for path in folder.iterdir()} & {"cube.yaml", "cube_body.stl"}
        assert len(copies) == 2 * is_copied
    with pytest.raises(InputError, match="mass of its own"):
        ObjectFiles(GraspRequest(str(own), mass_kg=1.0), folder)
    named = ObjectFiles(GraspRequest("scalpel"), folder).write_task(suggestion, 1)
    assert "object: scalpel\n" in named.read_text("utf-8")


@pytest.fixture
def suggestion(block: Path) -> Suggestion:
    return searches(load_hand("sa"), load_object(block), 2)[0].more(1, budget_s=600.0)[0]


def test_time_that_went_into_the_mesh_is_said_to_have_gone_there() -> None:
    assert "--budget" in Tried(2).remedy
    assert "convex pieces" in Tried(2, covered=1.0).remedy
