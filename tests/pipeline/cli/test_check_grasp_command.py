"""`check-proof` of grasp files, as a run leaves them."""

import json
from pathlib import Path

import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import RunRecord


def test_a_run_s_best_grasp_is_accepted(
    grasp_path: Path, run_record: RunRecord, capsys: pytest.CaptureFixture[str]
) -> None:
    best = run_record.grasps[0]
    assert best.evidence is not None and best.evidence.clear is not None and best.evidence.seal
    assert main(["check-proof", str(grasp_path)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("accepted: the contacts of upholding truly hold")
    assert ("to spare" in out) == (best.evidence.stable is not None)
    assert main(["check-proof", str(grasp_path), "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["accepted"] and found["clear"] and found["task"] == "upholding" and not found["reason"]
    if best.evidence.stable is not None:
        assert found["slack"] == pytest.approx(best.evidence.stable.slack, rel=1e-6)


@pytest.mark.parametrize("command", [["hold"], ["clear", "--margin", "0.0002"]], ids=["hold", "clear"])
def test_what_the_single_stages_write_is_accepted(
    command: list[str], grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    written = tmp_path / "written.json"
    name, *options = command
    assert main([name, str(grasp_path), *options, "--out", str(written)]) == 0
    capsys.readouterr()
    assert main(["check-proof", str(written)]) == 0
    out = capsys.readouterr().out
    assert "nothing sinks in" in out
    assert ("to spare" in out) == (json.loads(written.read_text("utf-8"))["evidence"]["stable"] is not None)


def test_a_grasp_written_elsewhere_still_finds_its_task(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    task = {
        "name": "mine",
        "hand": "sa",
        "object": "scalpel",
        "contacts": [
            {"hand": "index/tip", "object": "index_grip"},
            {"hand": "thumb/tip", "object": "thumb_grip"},
        ],
    }
    (tmp_path / "mine.yaml").write_text(json.dumps(task), "utf-8")
    found, elsewhere = tmp_path / "found", tmp_path / "a" / "b"
    elsewhere.mkdir(parents=True)
    assert main(["solve", str(tmp_path / "mine.yaml"), "--first", "--quiet", "--out", str(found)]) == 0
    moved = elsewhere / "moved.json"
    assert main(["clear", str(found / "g01.json"), "--out", str(moved)]) in (0, 4)
    capsys.readouterr()
    assert main(["check-proof", str(moved)]) in (0, 4)
    assert capsys.readouterr().err == ""


def test_a_changed_file_is_rejected(
    grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = json.loads(grasp_path.read_text("utf-8"))
    record["object"]["position"][0] += 1e-4
    changed = tmp_path / "changed.json"
    changed.write_text(json.dumps({**record, "task_source": "upholding"}), "utf-8")
    assert main(["check-proof", str(changed)]) == 4
    assert "rejected: the file was changed" in capsys.readouterr().out


def test_a_file_without_evidence_is_rejected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "upholding", "--first", "--quiet", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    assert main(["check-proof", str(tmp_path / "g01.json")]) == 4
    assert "rejected: evidence is missing" in capsys.readouterr().out


def test_what_is_no_grasp_file_costs_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "nonsense.json"
    file.write_text('{"joints": 3}', "utf-8")
    assert main(["check-proof", str(file)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert main(["check-proof", str(tmp_path / "none.json")]) == 2
