"""Saved drafts are loaded again as they were, and nothing is overwritten unasked."""

import dataclasses
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.objects import LiftTest, PressTest, load_object, load_task
from holdfast.objects.physical_test_file import PhysicalTestSpec, build_test
from holdfast.pipeline.cli.commands.pictures.edit import opened
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.edit import Draft, EditSource, save_task
from holdfast.pipeline.edit.conditions import fields_of_test, support_on, turn_about
from pydantic import TypeAdapter

from ..conftest import TONGS
from .conftest import asked


def test_a_mesh_is_saved_with_the_files_that_its_task_needs(
    of_block: tuple[Draft, EditSource], tmp_path: Path
) -> None:
    draft, source = of_block
    folder = tmp_path / "tasks"
    with pytest.raises(InputError, match="no place yet"):
        save_task(draft, source, folder, "push", overwrite=False)
    assert not folder.exists()
    draft.place(0, np.array([0.015, 0.0, 0.0]))
    reference = save_task(draft, source, folder, "push", overwrite=False)
    assert sorted(p.name for p in folder.iterdir()) == ["block.stl", "block.yaml", "push.yaml"]
    task = load_task(reference)
    assert task.object.inertia.mass == pytest.approx(draft.object.inertia.mass, rel=1e-5)
    saved, drawn = task.contacts[0], draft.pairs[0]
    assert saved.hand.name == drawn.hand.name
    assert np.array_equal(saved.object.region.patch.control_points, drawn.object.region.patch.control_points)
    before = {p: p.read_bytes() for p in folder.iterdir()}
    draft.resize(0, 0.004)
    with pytest.raises(InputError, match=r"push\.yaml: exists"):
        save_task(draft, source, folder, "push", overwrite=False)
    assert before == {p: p.read_bytes() for p in folder.iterdir()}
    save_task(draft, source, folder, "other", overwrite=False)  # the object file of this mesh may stay
    save_task(draft, source, folder, "push", overwrite=True)
    assert before[folder / "push.yaml"] != (folder / "push.yaml").read_bytes()
    (folder / "block.yaml").write_text("name: mine\n", "utf-8")
    with pytest.raises(InputError, match=r"block\.yaml: exists"):
        save_task(draft, source, folder, "third", overwrite=False)
    for name in ("../out", "", "block"):
        with pytest.raises(InputError, match="name"):
            save_task(draft, source, folder, name, overwrite=True)


def test_an_edited_task_keeps_what_the_editor_does_not_show(tmp_path: Path) -> None:
    draft, source, folder = opened(asked("tuning", save=tmp_path))
    assert folder == tmp_path
    old = load_task("tuning")
    draft.choose_hand(0, "middle/tip")
    task = load_task(save_task(draft, source, folder, "tuning_2", overwrite=False))
    assert task.name == "tuning_2" and task.contacts[0].hand.name == "middle/tip"
    assert type(task.test) is type(old.test) and task.test.parts == old.test.parts
    assert task.contacts[1].object.name == old.contacts[1].object.name
    swapped, source, folder = opened(asked("upholding", hand="shadow", save=tmp_path))
    save_task(swapped, source, folder, "held", overwrite=False)
    assert yaml.safe_load((tmp_path / "held.yaml").read_text("utf-8"))["hand"] == "shadow"


def test_a_hand_elsewhere_is_named_by_the_reference(block: Path, tmp_path: Path) -> None:
    text = (Path(__file__).parents[3] / "docs" / "files.md").read_text("utf-8")
    gripper = text.split("```yaml\nname: gripper")[1].split("```")[0]
    hands = tmp_path / "hands"
    hands.mkdir()
    (hands / "gripper.yaml").write_text(f"name: gripper{gripper}", "utf-8")
    draft, source, folder = opened(asked(block, hand=str(hands / "gripper.yaml"), save=tmp_path / "tasks"))
    draft.place(0, np.array([0.0, 0.0, 0.01]))
    reference = save_task(draft, source, folder, "pinch", overwrite=False)
    assert load_task(reference).hand.name == "gripper"


def test_what_lies_in_a_folder_beside_is_named_where_files_may_name_it(
    block: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "block.yaml"
    file.write_text("{name: block, mesh: block.stl, mass: 0.1, friction: 0.8}", "utf-8")
    words = asked(file, save=tmp_path / "tasks")
    monkeypatch.chdir(tmp_path)
    draft, source, folder = opened(words)
    draft.place(0, np.array([0.0, 0.0, 0.01]))
    task = load_task(save_task(draft, source, folder, "pinch", overwrite=False))
    assert task.object.name == "block"
    monkeypatch.chdir("/")
    with pytest.raises(InputError, match=r"can't name '.*block\.yaml': choose a folder above it"):
        save_task(draft, source, folder, "again", overwrite=False)


def test_units_of_a_mesh_and_a_bare_model_as_hand_come_back(tmp_path: Path) -> None:
    trimesh.creation.box((30.0, 100.0, 20.0)).export(tmp_path / "bar.stl")
    (tmp_path / "tongs.xml").write_text(TONGS, "utf-8")
    folder = tmp_path / "tasks"
    draft, source, _ = opened(
        asked(tmp_path / "bar.stl", hand=str(tmp_path / "tongs.xml"), units="mm", scale=0.5)
    )
    assert draft.object.mesh.extents == pytest.approx([0.015, 0.05, 0.01])
    draft.resize(0, 0.002)
    draft.place(0, np.array([0.0075, 0.0, 0.0]))
    task = load_task(save_task(draft, source, folder, "bar_tongs", overwrite=False))
    assert task.object.mesh.extents == pytest.approx([0.015, 0.05, 0.01])
    assert task.contacts[0].hand.name == draft.pairs[0].hand.name
    save_task(draft, source, folder, "again", overwrite=False)  # the object file is that of this mesh
    other = dataclasses.replace(source, scale=0.25)
    with pytest.raises(InputError, match=r"bar\.yaml: exists"):
        save_task(draft, other, folder, "third", overwrite=False)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["sa"], "is a hand"),
        (["upholding", "--mass", "1"], "goes with a mesh"),
        (["upholdng"], "did you mean 'upholding'"),
        (["block.stl", "--hand", "shadw"], "did you mean 'shadow'"),
    ],
)
def test_misuse_is_one_line(
    words: list[str],
    says: str,
    block: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(block.parent)
    assert main(["edit", *words]) == 2
    err = capsys.readouterr().err
    assert says in err and err.count("\n") == 1


def test_limits_test_and_support_are_saved_and_read_again(
    of_block: tuple[Draft, EditSource], tmp_path: Path
) -> None:
    draft, source = of_block
    draft.place(0, np.array([0.015, 0.0, 0.0]))
    joint, own = draft.hand.independent_names[1], draft.hand.limits[1]
    draft.limit(joint, float(own[0]), float(own.mean()))
    with pytest.raises(InputError, match=f"limits.{joint}: must lie inside the hand's own limits"):
        draft.limit(joint, float(own[0]) - 1.0, float(own[1]))
    assert draft.choose_test(PressTest((), 7.5)) == "press with 7.5 N at contacts 0"
    draft.choose_support(support_on(draft.object.mesh, "-z"))
    task = load_task(save_task(draft, source, tmp_path / "tasks", "push", overwrite=False))
    assert task.limits[1] == pytest.approx([own[0], own.mean()])
    assert np.array_equal(np.delete(task.limits, 1, axis=0), np.delete(draft.hand.limits, 1, axis=0))
    assert task.test == PressTest((0,), 7.5)
    assert task.support is not None
    assert (*task.support.point, *task.support.normal) == pytest.approx((0, 0, -0.01, 0, 0, 1))
    turn = turn_about(draft.object, "-y", 0.2, 30.0)
    assert turn.hinge_axis == (0.0, -1.0, 0.0) and turn.hinge_point == pytest.approx(
        draft.object.inertia.centre
    )
    assert draft.choose_test(turn).endswith("by 30 deg against 0.2 N m")
    assert load_task(save_task(draft, source, tmp_path / "tasks", "turn", overwrite=False)).test == replace(
        turn, parts=("block",)
    )
    # What is as usual again needs no field.
    draft.limit(joint, *own.tolist())
    draft.choose_test(LiftTest())
    draft.choose_support(None)
    save_task(draft, source, tmp_path / "tasks", "push", overwrite=True)
    fields = yaml.safe_load((tmp_path / "tasks" / "push.yaml").read_text("utf-8"))
    assert set(fields) == {"name", "hand", "object", "contacts"}


@pytest.mark.parametrize("name", ["tuning", "playing", "upholding"])
def test_tests_of_every_kind_are_written_as_they_are_read(name: str) -> None:
    test = load_task(name).test
    draft, _, _ = opened(asked(name))
    spec = TypeAdapter(PhysicalTestSpec).validate_python(fields_of_test(test))
    assert build_test(spec, draft.object, len(draft.pairs), "here") == test


def test_the_room_of_a_contact_stays(tmp_path: Path) -> None:
    region = next(iter(load_object("scalpel").regions))
    (tmp_path / "push.yaml").write_text(
        "name: push\nhand: sa\nobject: scalpel\ncontacts:\n"
        f"  - {{hand: index/tip, object: {region}, align_within_deg: 3}}\n",
        "utf-8",
    )
    draft, source, _ = opened(asked(tmp_path / "push.yaml", save=tmp_path))
    task = load_task(save_task(draft, source, tmp_path, "again", overwrite=False))
    assert task.contacts[0].align_within_deg == 3.0
