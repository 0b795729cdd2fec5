"""`holdfast clear`: the table of pairs, the margin, and what goes into the file."""

from pathlib import Path

import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import read_grasp


def test_table_shows_both_libraries_nearest_first(
    grasp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["clear", str(grasp_path), "--every-pair"]) == 0
    out = capsys.readouterr().out
    assert "FCL/mm" in out and "MuJoCo/mm" in out and "agree on all" in out
    rows = [line.split() for line in out.splitlines() if line.split()[2:3] in (["contact"], ["apart"])]
    ours, theirs = ([float(row[i]) for row in rows] for i in (3, 4))
    assert ours == sorted(ours)
    assert theirs == pytest.approx(ours, abs=1.1e-3, rel=1e-3)
    assert sum(row[2] == "contact" for row in rows) == 2
    assert main(["clear", str(grasp_path)]) == 0
    assert "--every-pair shows them" in capsys.readouterr().out


def test_margin_is_kept_and_written(
    grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "clear.json"
    assert main(["clear", str(grasp_path), "--clearance", "2e-3", "--out", str(out)]) == 0
    record = read_grasp(out)
    assert record.clearance is not None and record.approach is not None
    assert record.clearance.margin == 2e-3 and record.clearance.after >= 2e-3
    assert record.clearance.differing == []
    first, last = record.approach.waypoints[0], record.approach.waypoints[-1]
    assert last == {name: record.joints[name] for name in last}
    assert record.approach.reachable == (record.approach.opening >= 0.01)
    assert first != last


@pytest.mark.parametrize("margin", ["-0.001", "nan", "1", "much"])
def test_bad_margin_is_one_line(grasp_path: Path, margin: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["clear", str(grasp_path), f"--clearance={margin}"]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "--clearance" in err
