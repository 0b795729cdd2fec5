"""What a run is asked for means the same from Python and from the command line."""

import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from holdfast.errors import InputError, UnknownName
from holdfast.mjcf import HoldSettings, preset_settings
from holdfast.objects import Task, builtin_tasks, load_task
from holdfast.pipeline.cli.commands.grasps import run as command
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import read_grasp, to_json
from holdfast.pipeline.run import RunSettings, run_task

from .test_run import without_times

NINE = [name for name in builtin_tasks() if "/" not in name]


class Asked(Exception):
    """Stands in for a run: what it was asked for."""


@pytest.mark.parametrize("name", NINE)
def test_the_command_line_asks_for_what_python_asks_for(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[Task, RunSettings]] = []

    def record(reference: str, path: Path, settings: RunSettings, **_: Any) -> None:
        asked.append((load_task(reference), settings))
        raise Asked

    monkeypatch.setattr(command, "run_task", record)
    with pytest.raises(Asked):
        main(["run", name, "--quiet", "--out", str(tmp_path / "run")])
    ((task, settings),) = asked
    assert settings.as_record(task) == RunSettings().as_record(task)
    assert settings.hold_settings(task) == preset_settings("holdfast", task)
    assert (settings.seed, settings.budget_s) == (RunSettings().seed, RunSettings().budget_s)


def test_there_are_nine_tasks_and_not_all_of_them_are_tested_in_six_directions() -> None:
    assert len(NINE) == 9
    own = [RunSettings().hold_settings(load_task(name)).directions for name in NINE]
    assert any(directions != HoldSettings().directions for directions in own)


@pytest.mark.usefixtures("without_pictures")
def test_a_run_from_python_is_the_run_of_the_command_line(tmp_path: Path) -> None:
    """On a task with one direction of gravity: settings of six would make another run of it."""
    contacts = [{"hand": f"{finger}/tip", "object": f"{finger}_grip"} for finger in ("index", "thumb")]
    test = {"kind": "lift", "gravity": [[0.0, 0.0, 1.0]]}
    data = {"name": "mine", "hand": "sa", "object": "scalpel", "contacts": contacts, "test": test}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(data), "utf-8")
    words = ["--candidates", "2", "--seed", "1", "--workers", "1", "--quiet", "--out", str(tmp_path / "cli")]
    code = main(["run", str(file), *words])
    record = run_task(file, tmp_path / "python", RunSettings(candidates=2, seed=1))
    assert code == 0 and record.verdict == "held"
    assert without_times(tmp_path / "cli") == without_times(tmp_path / "python")
    for grasp in record.grasps:
        assert grasp.hold is None or len(grasp.hold.directions) <= 1
        one, other = (read_grasp(tmp_path / n / "grasps" / f"{grasp.id}.json") for n in ("cli", "python"))
        assert to_json(one) == to_json(other)


def test_single_fields_of_the_test_are_overridden_and_the_others_stay() -> None:
    task = load_task("transportation")
    settings = RunSettings(hold={"hold_s": 0.5}).hold_settings(task)
    assert settings.hold_s == 0.5
    assert settings.directions == preset_settings("holdfast", task).directions
    other = RunSettings(preset="dexgraspbench", hold={"friction": 0.7}).hold_settings(task)
    assert (other.preset, other.friction) == ("dexgraspbench", 0.7)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"candidates": 0}, "candidates"),
        ({"seed": -1}, "seed"),
        ({"sigma": float("nan")}, "sigma"),
        ({"budget_s": float("nan")}, "budget_s"),
        ({"budget_s": float("inf")}, "budget_s"),
        ({"wanted": -1}, "wanted"),
        ({"margin_m": -1e-3}, "margin_m"),
        ({"margin_m": float("nan")}, "margin_m"),
        ({"workers": -3}, "workers"),
    ],
)
def test_values_out_of_range_are_refused_by_name(given: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError, match=rf"RunSettings: {field}: must be") as caught:
        RunSettings(**given)
    assert caught.value.field == field


def test_names_that_do_not_exist_are_refused_with_those_that_do() -> None:
    with pytest.raises(UnknownName, match=r"did you mean 'hold_s'"):
        RunSettings(hold={"holds": 1.0})
    with pytest.raises(UnknownName, match="unknown preset"):
        RunSettings(preset="holdfsat").hold_settings(load_task("upholding"))


@pytest.mark.usefixtures("without_pictures")
def test_a_task_built_in_python_runs_and_its_files_ask_for_the_task(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from dataclasses import replace

    task = replace(load_task("upholding"), name="mine")
    record = run_task(task, tmp_path, RunSettings(candidates=1, wanted=1))
    assert record.task == "mine" and record.task_source == "" and record.grasps
    file = tmp_path / "grasps" / f"{record.grasps[0].id}.json"
    assert json.loads(file.read_text("utf-8"))["task_source"] == ""
    assert main(["hold", str(file), "--task", "upholding"]) == (0 if record.grasps[0].is_held else 4)
    capsys.readouterr()
    assert main(["hold", str(file)]) == 2
    assert "task_source: is empty" in capsys.readouterr().err
