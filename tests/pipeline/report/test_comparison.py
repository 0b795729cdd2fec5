"""Two runs beside each other."""

import json
from dataclasses import astuple
from pathlib import Path

import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import RunFolder, RunRecord, to_json
from holdfast.pipeline.report import compare_runs


def test_a_run_is_like_itself(run_record: RunRecord) -> None:
    found = compare_runs(run_record, run_record)
    assert found.settings == [] and found.grasps == []
    assert found.same_grasps == len(run_record.grasps)
    assert not any(row.differs for row in (*found.counts, *found.times))
    counts = {row.name: row.first for row in found.counts}
    assert counts["tried"] == str(len(run_record.grasps)) and counts["all three"] == str(len(run_record.good))


def test_what_differs_is_named(
    run_record: RunRecord, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    best, *others = run_record.grasps
    assert best.hold is not None
    lost = best.model_copy(update={"hold": best.hold.model_copy(update={"held": False})})
    changed = run_record.model_copy(
        update={
            "seed": 7,
            "settings": {**run_record.settings, "candidates": 99},
            "grasps": [lost, *others],
            "seconds": {"solve": 1.0},
        }
    )
    found = compare_runs(run_record, changed)
    assert [astuple(row) for row in found.settings] == [
        ("seed", str(run_record.seed), "7"),
        ("candidates", str(run_record.settings["candidates"]), "99"),
    ]
    assert [(row.name, row.second) for row in found.grasps] == [(best.id, "gave way")]
    assert found.same_grasps == len(others)
    folders = []
    for name, record in (("a", run_record), ("b", changed)):
        (tmp_path / name).mkdir()
        RunFolder(tmp_path / name).save(record)
        folders.append(str(tmp_path / name))
    assert main(["compare", *folders]) == 0
    shown = capsys.readouterr().out
    assert "candidates" in shown and "gave way" in shown and f"{len(others)} grasps came equally far" in shown
    assert main(["compare", *folders, "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["grasps"][0]["name"] == best.id and said["runs"] == folders
    assert main(["compare", folders[0], str(tmp_path / "none")]) == 2
    assert "is not a run folder" in capsys.readouterr().err
    assert to_json(run_record)["grasps"]
