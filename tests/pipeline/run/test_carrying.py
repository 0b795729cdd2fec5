"""What a run says of its contacts before anything else."""

from pathlib import Path

import pytest
from holdfast.base.text.console import Console
from holdfast.mjcf import preset_settings
from holdfast.objects import Task, load_task
from holdfast.pipeline.cli.commands.grasps.run import summary
from holdfast.pipeline.records import CarryingRecord, Limit, RunRecord, read_run
from holdfast.pipeline.report.report import render_report
from holdfast.pipeline.run import RunSettings, run_task
from holdfast.pipeline.run.carrying import find_carrying, with_others

RIM = {"index/tip": "rim_below", "thumb/tip": "rim_above"}


def plate() -> Task:
    return Task(hand="sa", object="family:plate:34", contacts=RIM, name="rim")


def test_too_little_is_said_first_and_recorded_and_the_run_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = RunSettings(candidates=1, seed=1, budget_s=120.0, wanted=0, quick=True)
    record = run_task(plate(), tmp_path / "r", settings, console=Console(), should_stop=lambda: False)
    lines = [line for line in "".join(capsys.readouterr()).splitlines() if line.strip()]
    said = lines[0]
    assert "these contacts carry at most 0." in said
    assert "not proved" in said
    assert "these would: index/tip - " in said
    assert record.carrying is not None
    assert record.carrying.text == said
    assert record.solve is not None
    assert read_run(tmp_path / "r" / "run.json").carrying == record.carrying
    assert "carry at most 0." in (tmp_path / "r" / "report.html").read_text("utf-8")


def test_the_settings_of_the_test_decide_friction_and_weight() -> None:
    task = plate()
    usual, light = (
        find_carrying(task, preset_settings(name, task)) for name in ("holdfast", "dexgraspbench")
    )
    assert usual is not None
    assert light is not None
    assert usual.limit is not None
    assert light.multiple > 2.0 * usual.multiple  # 0.1 kg
    assert light.friction == 0.6


def test_where_no_plan_does_others_are_named_in_the_end(run_record: RunRecord, tmp_path: Path) -> None:
    """Contacts that seem to carry the load at single points, and no grasp of the run that does by plan."""
    task = load_task(run_record.task)
    found = find_carrying(task, preset_settings("holdfast", task))
    assert found is not None and found.limit is None and not found.instead
    others = with_others(task, preset_settings("holdfast", task), found)
    assert others.instead
    assert others == found.model_copy(update={"instead": others.instead})
    limit = Limit(load_factor=0.5, wanted=1.5, words="carries at most half")
    hold = run_record.grasps[0].hold
    assert hold is not None
    failed = hold.model_copy(update={"held": False, "limit": limit})
    grasp = run_record.grasps[0].model_copy(update={"hold": failed})
    record = run_record.model_copy(update={"grasps": [grasp], "verdict": "not held", "carrying": others})
    said = f"ontacts that would carry it (computed): {', '.join(others.instead)}"
    assert f"c{said}\n" in summary(record)
    assert f"C{said}." in render_report(task, record, tmp_path)
    assert said not in summary(record.model_copy(update={"carrying": found}))


def test_what_carries_needs_no_others_and_what_a_stand_holds_nothing() -> None:
    box = load_task("family:box:3")
    found = find_carrying(box, preset_settings("holdfast", box))
    assert isinstance(found, CarryingRecord)
    assert found.limit is None
    assert found.instead == []
    tuning = load_task("tuning")
    assert find_carrying(tuning, preset_settings("holdfast", tuning)) is None


def test_records_of_before_have_none() -> None:
    fields = {"holdfast": "0", "task": "t", "task_source": "", "task_fingerprint": "", "seed": 0}
    assert RunRecord.model_validate({**fields, "hand": "h", "object": "o"}).carrying is None
