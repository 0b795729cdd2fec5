"""Every grasp gets its verdict before any gets margin, other settings or pictures; `quick` ends there."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from holdfast.base.text.console import Console
from holdfast.errors import InputError
from holdfast.mjcf import hold_margin, hold_test
from holdfast.objects import load_task
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import GraspRecord, RunRecord, updated
from holdfast.pipeline.run import RunSettings, run_task
from holdfast.pipeline.run.crew import Crew
from holdfast.pipeline.run.extras import FindExtras
from holdfast.pipeline.run.recorded_grasp import to_grasp

from .test_run import SETTINGS, without_times


class _Lines(Console):
    def __init__(self) -> None:
        super().__init__(quiet=True)
        self.said: list[str] = []

    def say(self, text: str) -> None:
        self.said.append(text)


@pytest.fixture(scope="module")
def quick_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("quick") / "run"
    run_task("upholding", path, replace(SETTINGS, quick=True))
    return path


def test_a_quick_run_stops_at_the_verdicts_and_says_so(quick_path: Path) -> None:
    data = json.loads((quick_path / "run.json").read_text("utf-8"))
    assert data["complete"] and data["quick"] and data["verdict"] == "held"
    assert all(grasp["hold"]["margin"] is None for grasp in data["grasps"])
    assert all("epsilon" not in grasp["quality"] for grasp in data["grasps"])
    assert not (quick_path / "media").exists() or not list((quick_path / "media").iterdir())
    assert "verdicts only" in (quick_path / "report.html").read_text("utf-8")


@pytest.mark.usefixtures("without_pictures")
def test_a_quick_run_that_goes_on_becomes_the_whole_run(quick_path: Path, run_path: Path) -> None:
    lines = _Lines()
    record = run_task("upholding", quick_path, SETTINGS, resume=True, console=lines)
    assert record.complete and not record.quick
    assert without_times(quick_path) == without_times(run_path)
    assert all(grasp.is_measured for grasp in record.grasps if grasp.is_clear)
    assert sum("up to" in line for line in lines.said) == sum(grasp.is_held for grasp in record.grasps)


@pytest.mark.usefixtures("without_pictures")
def test_all_verdicts_come_before_the_first_margin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped as soon as a margin is looked for: no grasp is without a verdict then."""
    whole = Crew.results
    is_over = [False]

    def stopped(self: Crew, jobs, **asked):  # type: ignore[no-untyped-def]
        if any(isinstance(job, FindExtras) for job in jobs):
            is_over[0] = True
        return whole(self, jobs, **asked)

    monkeypatch.setattr(Crew, "results", stopped)
    lines = _Lines()
    record = run_task("upholding", tmp_path, SETTINGS, should_stop=lambda: is_over[0], console=lines)
    assert is_over[0] and not record.complete and record.verdict == "held"
    assert all(grasp.is_done and grasp.hold is not None for grasp in record.grasps)
    assert all(grasp.lacks_extras for grasp in record.good)
    assert any(line.startswith("without margin") for line in lines.said)


def test_the_margin_of_a_run_is_that_of_its_grasp_files(run_path: Path, run_record: RunRecord) -> None:
    """What is recorded suffices to repeat test and margin bit by bit."""
    task = load_task("upholding")
    settings = SETTINGS.hold_settings(task)
    for grasp in run_record.grasps:
        assert grasp.hold is not None
        simulated = to_grasp(grasp, task, settings, run_path / "run.json")
        assert simulated is not None
        result = hold_test(simulated)
        assert [d.slip_m for d in result.directions] == [d.slip for d in grasp.hold.directions]
        if grasp.is_held:
            assert grasp.hold.margin == hold_margin(simulated) >= 1.0


def test_a_record_without_forces_has_no_grasp_and_one_of_another_hand_is_refused(
    run_record: RunRecord,
) -> None:
    task = load_task("upholding")
    settings = SETTINGS.hold_settings(task)
    tested = run_record.grasps[0]
    assert tested.hold is not None and tested.hold.squeeze is not None

    def with_squeeze(**changed: object) -> GraspRecord:
        squeeze = tested.hold.squeeze.model_copy(update=changed)  # type: ignore[union-attr]
        return updated(tested, hold=tested.hold.model_copy(update={"squeeze": squeeze}))  # type: ignore[union-attr]

    assert to_grasp(with_squeeze(contact_forces=[]), task, settings, "run.json") is None
    with pytest.raises(InputError, match=r"squeeze.targets: must give the \d+ independent"):
        to_grasp(with_squeeze(targets={"thumb": 1.0}), task, settings, "run.json")


def test_the_command_line_asks_for_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["--candidates", "1", "--wanted", "1", "--quick", "--out", str(tmp_path / "r")]
    assert main(["run", "upholding", *asked]) == 0
    assert "verdicts only" in capsys.readouterr().out


def test_settings_say_what_a_run_is_asked_for_and_quick_is_no_part_of_what_it_finds() -> None:
    task = load_task("upholding")
    assert RunSettings(quick=True).as_record(task) == RunSettings().as_record(task)
