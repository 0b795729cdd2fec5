"""A run says first that friction does not do, where that is proved, and nothing else changes."""

import json
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import pytest
from holdfast.mjcf import HoldSettings, preset_settings
from holdfast.objects import LiftTest, Task, load_task
from holdfast.pipeline.cli import main
from holdfast.pipeline.run import RunSettings, run_task
from holdfast.pipeline.run.statics import refuted_by_statics


def with_friction(name: str, friction: float) -> Task:
    task = load_task(name)
    return replace(task, object=replace(task.object, friction=friction))


def refuted(task: Task, hold: HoldSettings | None = None) -> bool:
    settings = hold or preset_settings("holdfast", task)
    return refuted_by_statics(task, RunSettings(), settings, should_stop=lambda: False) is not None


def test_it_is_about_the_friction_and_the_directions_of_the_test() -> None:
    slippery = with_friction("handling", 0.05)
    hold = preset_settings("holdfast", slippery)
    assert refuted(slippery)
    assert not refuted(slippery, replace(hold, friction=0.6))
    assert not refuted(slippery, replace(hold, directions=((0.0, 0.0, 1.0),)))
    assert not refuted(load_task("handling"))
    assert refuted(load_task("handling"), replace(hold, friction=0.05))
    # Pads are no points: what the points' limit forbids narrowly, they may hold.
    assert not refuted(with_friction("handling", 0.155))
    assert not refuted(replace(slippery, test=LiftTest(directions=((0.0, 0.0, -1.0),))))


@pytest.mark.usefixtures("without_pictures")
def test_a_slippery_task_ends_at_once(tmp_path: Path) -> None:
    record = run_task(with_friction("handling", 0.05), tmp_path / "run", RunSettings(budget_s=60.0))
    assert record.verdict == "infeasible" and record.lacks_friction and record.complete
    assert record.solve is not None and record.solve.rounds[0].lps == 0
    assert sum(record.seconds.values()) < 6.0
    assert "can hold the load with its friction" in (tmp_path / "run" / "report.html").read_text("utf-8")


def test_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    proof = tmp_path / "least.proof"
    assert main(["best", "upholding", "--for", "friction", "--proof", str(proof), "--quiet"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("upholding: needs friction 0.379") and "(proved)" in said
    assert main(["check-proof", str(proof), "--task", "upholding"]) == 0
    assert "its own friction is 0.6" in capsys.readouterr().out
    assert main(["check-proof", str(proof), "--task", "handling"]) == 4
    assert "not those of the task" in capsys.readouterr().out
    for words, what in (
        (["best", "service", "--for", "friction"], "says nothing of this task"),
        (["best", "upholding"], "--for"),
        (["best", "upholding", "--for", "weight"], "load"),
        (["best", "upholding", "--for", "friction", "--gap", "2"], "--gap"),
        (["best", "upholding", "--for", "friction", "--resume"], "--checkpoint"),
        (["solve", "upholding", "--all", "--statics"], "--statics"),
        (["check-proof", str(proof), "--task", "service"], "says nothing of this task"),
    ):
        assert main([*words, "--quiet"] if words[0] != "check-proof" else words) == 2
        complaint = capsys.readouterr().err
        assert what in complaint and complaint.count("\n") == 1


def test_solve_with_statics_and_explain(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = Path(str(files("holdfast.objects"))) / "data"
    scalpel = (data / "scalpel.yaml").read_text("utf-8")
    (tmp_path / "slippery.yaml").write_text(scalpel.replace("friction: 0.6\n", "friction: 0.1\n"), "utf-8")
    handling = (data / "tasks" / "handling.yaml").read_text("utf-8")
    task, proof = tmp_path / "task.yaml", tmp_path / "no.proof"
    task.write_text(handling.replace("object: scalpel", "object: slippery.yaml"), "utf-8")
    words = ["solve", str(task), "--statics", "--proof", str(proof), "--explain", "20", "--quiet"]
    assert main([*words, "--json", "-"]) == 3
    said = json.loads(capsys.readouterr().out)
    assert said["statics"]["verdict"] == said["verdict"] == "infeasible"
    assert said["statics"]["refuted"] == 0.1 and said["lps"] == 0
    assert "needs friction 0.16" in said["hints"][0] and "(proved)" in said["hints"][0]
    assert main(["check-proof", str(proof), "--task", str(task)]) == 0
    assert "handling is infeasible: its regions can't hold" in capsys.readouterr().out
    assert main(["solve", str(task), "--first", "--quiet"]) == 0
    capsys.readouterr()
    assert main(["solve", "handling", "--statics", "--first", "--quiet"]) == 0
    assert "forces at its regions balance with friction 0.6" in capsys.readouterr().out
