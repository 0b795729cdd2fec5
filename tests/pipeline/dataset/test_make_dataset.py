"""A data set is the same however it was made: in one go, after a kill, by one process or two."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError, UnknownName
from holdfast.hands import load_hand
from holdfast.mjcf import preset_settings
from holdfast.pipeline.choice import ChoiceData, DrawRanges, load_dataset, task_of, to_grasp, try_under
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.dataset import DatasetPlan, make_dataset
from holdfast.pipeline.dataset.make import _jobs, parts_of
from holdfast.pipeline.dataset.part import make_part
from holdfast.pipeline.records import fingerprint

from ..conftest import environment_for_subprocess

pytest.importorskip("pyarrow")

PLAN = DatasetPlan(families=("box", "cylinder"), objects=2, candidates=2, draws=1, seed=3)
WORDS = ("--families", "box,cylinder", "--objects", "2", "--candidates", "2", "--draws", "1", "--seed", "3")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "made"
    result = make_dataset(PLAN, folder, command="holdfast dataset ...")
    assert result.complete and (result.made, result.situations, result.candidates, result.labels) == (
        2,
        2,
        4,
        8,
    )
    return folder


@pytest.fixture(scope="module")
def data(folder: Path) -> ChoiceData:
    return load_dataset(folder)


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def without_command(files: dict[str, bytes]) -> dict[str, bytes]:
    """The files that don't say by which command they were made."""
    return {
        name: data
        for name, data in files.items()
        if name not in ("dataset.json", "README.md", "croissant.json")
    }


def test_every_candidate_is_certified_clear_and_tried_as_written(folder: Path, data: ChoiceData) -> None:
    parts = parts_of(PLAN, folder)
    row = 0
    for part in parts:
        assert part.situation is not None and part.told is not None
        task = task_of(part.situation, folder)
        settings = preset_settings("holdfast", task)
        assert part.told.hand_hash == fingerprint(load_hand("sa"))
        for k, candidate in enumerate(part.candidates):
            assert candidate.solution.certified and candidate.clearance >= -1e-4
            assert candidate.solution.joints.keys() == set(task.hand.joint_names)
            conditions = np.array(part.conditions[0], dtype=np.float32)
            found = try_under(to_grasp(candidate, task, settings, folder), conditions, PLAN.loads, settings)
            assert [(one.held, one.margin) for one in found] == [
                (o.held, o.margin) for o in part.outcomes[k][0]
            ]
            assert data.held[row, 0].tolist() == [one.held for one in found]
            assert data.margin[row, 0] == pytest.approx([one.margin for one in found])
            row += 1
    assert row == len(data)


def test_margins_agree_with_verdicts(data: ChoiceData) -> None:
    assert ((data.margin > 0.0) <= data.held).all() and ((data.margin < 0.0) <= ~data.held).all()
    assert (np.abs(data.margin) <= 1.0).all() and (data.held[:, :, 1] <= data.held[:, :, 0]).all()


def test_features_lie_within_their_bounds(data: ChoiceData) -> None:
    for specs, values in ((data.feature_specs, data.features), (data.object_specs, data.object_features)):
        for k, feature in enumerate(specs):
            assert feature.low - 1e-6 <= values[:, k].min() and values[:, k].max() <= feature.high + 1e-6, (
                feature
            )


def test_a_second_call_makes_nothing_anew(folder: Path) -> None:
    before = content(folder)
    result = make_dataset(PLAN, folder, command="holdfast dataset ...")
    assert result.made == 0 and result.complete and content(folder) == before


def test_a_part_does_not_depend_on_the_others(folder: Path) -> None:
    plan = replace(PLAN, families=("cylinder",), objects=1)
    (job,) = plan.situations()
    assert make_part(job, plan) == parts_of(PLAN, folder)[1]


@pytest.mark.slow
def test_a_larger_plan_takes_what_is_there(folder: Path, tmp_path: Path) -> None:
    other = tmp_path / "grown"
    make_dataset(replace(PLAN, objects=1), other)
    result = make_dataset(PLAN, other, command="holdfast dataset ...")
    for name in ("box", "cylinder"):  # the date of the data is that of its last part
        part = next((folder / "parts").glob(f"*{name}*"))
        os.utime(other / "parts" / part.name, ns=(part.stat().st_mtime_ns,) * 2)
    make_dataset(PLAN, other, command="holdfast dataset ...")
    assert result.made == 1 and content(other) == content(folder)


def test_one_hand_in_turn_for_each_object(folder: Path, tmp_path: Path) -> None:
    """No family has one hand alone, and what lies there of other hands is kept."""
    plan = DatasetPlan(objects=36, hands=("sa", "shadow", "claw"), one_hand=True)
    dealt = plan.situations()
    assert [job.object for job in dealt] == [job.object for job in plan.pairs()[::3]]
    for family in plan.families:
        hands = [job.hand for job in dealt if f":{family}:" in job.object]
        assert sorted(hands) == sorted(2 * plan.hands)
    grown = replace(PLAN, hands=("shadow", "sa"), one_hand=True)
    shutil.copytree(folder / "parts", tmp_path / "parts")
    (tmp_path / "plan.json").write_bytes((folder / "plan.json").read_bytes())
    jobs = _jobs(grown, tmp_path)
    assert [(job.object[7:], job.hand) for job in jobs] == [
        ("box:0", "shadow"),
        ("box:0", "sa"),
        ("cylinder:0", "sa"),
    ]


def test_another_recipe_is_refused(folder: Path) -> None:
    for changes, name in (
        ({"draws": 2}, "draws"),
        ({"candidates": 3}, "candidates"),
        ({"ranges": DrawRanges(shift_m=0.0)}, "ranges"),
    ):
        with pytest.raises(InputError, match=f"other {name}"):
            make_dataset(replace(PLAN, **changes), folder)


def test_who_asks_to_stop_keeps_what_is_finished(tmp_path: Path) -> None:
    asked = iter([False] * 3)
    result = make_dataset(PLAN, tmp_path / "stopped", should_stop=lambda: next(asked, True))
    assert not result.complete and not (tmp_path / "stopped" / "dataset.json").exists()
    with pytest.raises(InputError, match="is no data set"):
        load_dataset(tmp_path / "stopped")


@pytest.mark.slow
def test_a_killed_command_goes_on_to_the_same(folder: Path, tmp_path: Path) -> None:
    """Killed in the middle, with two processes, and begun again: as if nothing had been."""
    out = tmp_path / "killed"
    command = [
        sys.executable,
        "-m",
        "holdfast",
        "dataset",
        *WORDS,
        "--out",
        str(out),
        "--workers",
        "2",
        "--quiet",
    ]
    process = subprocess.Popen(command, env=environment_for_subprocess(), start_new_session=True)
    deadline = time.monotonic() + 300.0
    while not list((out / "parts").glob("*.json")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    kept = {path.name: path.stat().st_mtime_ns for path in (out / "parts").glob("*.json")}
    subprocess.run(command, env=environment_for_subprocess(), check=True)
    assert without_command(content(out)) == without_command(content(folder))
    assert all((out / "parts" / name).stat().st_mtime_ns == at for name, at in kept.items())


def test_the_command_says_what_it_has_made(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["dataset", *WORDS, "--out", str(folder), "--workers", "1", "--quiet", "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["complete"], said["candidates"], said["labels"]) == (True, 4, 8)
    assert "--families box,cylinder --objects 2" in (folder / "README.md").read_text("utf-8")


@pytest.mark.parametrize(
    ("changes", "error", "match"),
    [
        ({"families": ("mgu",)}, UnknownName, "did you mean 'mug'"),
        ({"families": ("mug", "mug")}, InputError, "twice"),
        ({"objects": 0}, InputError, "at least 1"),
        ({"hands": ()}, InputError, "at least one hand"),
        ({"candidates": 1}, InputError, "candidates"),
        ({"loads": (2.0, 1.0)}, InputError, "ascending"),
        ({"loads": ()}, InputError, "loads"),
    ],
)
def test_misuse_of_a_plan_is_named(changes: dict[str, object], error: type[InputError], match: str) -> None:
    with pytest.raises(error, match=match):
        replace(PLAN, **changes)  # type: ignore[arg-type]


def test_what_can_not_be_loaded_is_named_before_the_work(tmp_path: Path) -> None:
    for changes, match in (
        ({"hands": ("shadwo",)}, "did you mean 'shadow'"),
        ({"references": ("teapto",)}, "did you mean 'teapot'"),
    ):
        with pytest.raises(InputError, match=match):
            make_dataset(replace(PLAN, **changes), tmp_path / "x")  # type: ignore[arg-type]
    assert not (tmp_path / "x").exists()
