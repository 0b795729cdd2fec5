"""The folder of a run: what a fresh one removes, and which run it may replace."""

import os
from pathlib import Path

import pytest
from holdfast.base.files.output_file import write_json
from holdfast.errors import InputError
from holdfast.pipeline.records import RunFolder, RunRecord, read_run, to_json
from holdfast.pipeline.run.begin import begin, free_folder, own_folder


@pytest.fixture
def folder(tmp_path: Path, run_record: RunRecord) -> RunFolder:
    """A finished run, with empty files in place of what it wrote, and files of a person among them."""
    folder = RunFolder(tmp_path / "run")
    (folder.path / "grasps").mkdir(parents=True)
    folder.media.mkdir()
    folder.save(run_record)
    for grasp in run_record.grasps:
        folder.grasp_path(grasp.id).touch()
        folder.grasp_path(grasp.id, ".xml").touch()
        (folder.media / f"{grasp.id}_front.png").touch()
    for name in MINE:
        (folder.path / name).touch()
    return folder


MINE = (
    ".gitkeep",
    "grasps/.notes",
    "grasps/g77.json",
    "grasps/g01_mine.json",
    "media/g01_mine.png",
    "media/g01_front.png.txt",
    "notes.txt",
)


def fresh(record: RunRecord, **changes: object) -> RunRecord:
    return record.model_copy(update={"grasps": [], "solve": None, "complete": False, **changes})


def names(folder: RunFolder) -> set[str]:
    return {str(path.relative_to(folder.path)) for path in folder.path.rglob("*") if path.is_file()}


def test_the_record_is_written_whole_whatever_was_written_before(
    tmp_path: Path, run_record: RunRecord
) -> None:
    """Grasp by grasp, and only those that are new; what stands there is what the record says."""
    folder, whole = RunFolder(tmp_path), tmp_path / "whole.json"
    first, *others = run_record.grasps
    changed = first.model_copy(update={"restarts": first.restarts + 7})
    for grasps in (run_record.grasps, [*others, changed], [], [first], run_record.grasps):
        record = run_record.model_copy(update={"grasps": grasps})
        folder.save(record)
        write_json(whole, to_json(record))
        assert folder.record_path.read_bytes() == whole.read_bytes()


def test_a_fresh_run_removes_what_the_earlier_one_wrote_and_nothing_else(
    folder: RunFolder, run_record: RunRecord
) -> None:
    folder.start(fresh(run_record))
    assert names(folder) == {*MINE, "run.json"}


@pytest.mark.parametrize(
    ("field", "changes"),
    [
        ("task", {"task": "other"}),
        ("task_fingerprint", {"task_fingerprint": "0"}),
        ("seed", {"seed": 7}),
        ("settings.sigma", {"settings": {"sigma": 0.2}}),
    ],
)
def test_another_run_is_not_replaced_unless_forced(
    field: str, changes: dict[str, object], folder: RunFolder, run_record: RunRecord
) -> None:
    before = names(folder)
    other = fresh(run_record, **changes)
    with pytest.raises(InputError, match="--force") as caught:
        begin(other, folder, resume=False)
    assert caught.value.field == field
    assert names(folder) == before and read_run(folder.record_path) == run_record
    begin(other, folder, resume=False, force=True)
    assert names(folder) == {*MINE, "run.json"}


def test_of_a_run_that_can_not_be_read_nothing_is_removed(folder: RunFolder, run_record: RunRecord) -> None:
    folder.record_path.write_text("{", "utf-8")
    before = names(folder)
    with pytest.raises(InputError, match="--force"):
        folder.start(fresh(run_record))
    folder.start(fresh(run_record), force=True)
    assert names(folder) == before


@pytest.mark.parametrize("name", ["grasps", "media"])
def test_no_run_begins_over_a_linked_folder(name: str, tmp_path: Path, run_record: RunRecord) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "g01.json").touch()
    folder = RunFolder(tmp_path / "run")
    folder.path.mkdir()
    (folder.path / name).symlink_to(elsewhere)
    with pytest.raises(InputError, match="is a link"), folder.writing():
        folder.start(fresh(run_record))
    assert os.listdir(elsewhere) == ["g01.json"]


def test_without_a_name_each_run_has_a_folder_of_its_own(folder: RunFolder, run_record: RunRecord) -> None:
    other = fresh(run_record, seed=7)
    assert own_folder(folder.path, fresh(run_record)) == folder.path
    second = own_folder(folder.path, other)
    assert second == free_folder(folder.path) == folder.path.with_name("run_2")
    RunFolder(second).save(other)
    assert own_folder(folder.path, other) == second
    assert own_folder(folder.path, fresh(run_record, seed=8)).name == "run_3"


def test_a_run_of_another_version_is_not_gone_on_with(folder: RunFolder, run_record: RunRecord) -> None:
    folder.save(run_record.model_copy(update={"holdfast": "9.9"}))
    with pytest.raises(InputError, match=r"holdfast: is '9\.9', but this is"):
        begin(fresh(run_record), folder, resume=True)


@pytest.mark.parametrize(
    ("says", "edit"),
    [
        ("rounds", lambda d: d["solve"].update(rounds=[])),
        ("id must be g and a number", lambda d: d["grasps"][0].update(id="best")),
        ("that no other has", lambda d: d["grasps"].append(d["grasps"][0])),
        ("are listed, but", lambda d: d["grasps"].pop()),
        (r"written by version '9\.9'", lambda d: d.update(holdfast="9.9", verdict="great")),
    ],
)
def test_nonsense_in_a_record_is_refused(
    says: str, edit: object, run_record: RunRecord, tmp_path: Path
) -> None:
    data = to_json(run_record)
    edit(data)  # type: ignore[operator]
    write_json(tmp_path / "run.json", data)
    with pytest.raises(InputError, match=says):
        read_run(tmp_path / "run.json")


def test_parts_that_a_killed_run_has_left_are_removed(folder: RunFolder, run_record: RunRecord) -> None:
    before = names(folder)
    for name in (".0badcafe-0badcafe.part", "grasps/.12345678-12345678.part"):
        (folder.path / name).touch()
    folder.remove_parts()
    assert names(folder) == before | {".0badcafe-0badcafe.part"}  # which is no part of a file of the run
