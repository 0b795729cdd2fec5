"""`holdfast solve --explain`: what, relaxed alone, would make an infeasible task possible."""

import json
from pathlib import Path

import pytest
from holdfast.pipeline.cli.main import main

SLAB = """\
name: slab
box: {half_extents: [0.02, 0.02, 0.13]}
mass: 0.1
friction: 0.6
regions:
  front: {bezier: [[[-0.02, -0.02, 0.13], [-0.02, 0.02, 0.13]], [[0.02, -0.02, 0.13], [0.02, 0.02, 0.13]]]}
  back: {bezier: [[[-0.02, -0.02, -0.13], [0.02, -0.02, -0.13]], [[-0.02, 0.02, -0.13], [0.02, 0.02, -0.13]]]}
"""
TASK = """\
name: slab
hand: sa
object: slab_object.yaml
contacts:
  - {hand: index/tip, object: front}
  - {hand: thumb/tip, object: back}
"""


@pytest.fixture
def slab(tmp_path: Path) -> Path:
    (tmp_path / "slab_object.yaml").write_text(SLAB, "utf-8")
    task = tmp_path / "slab.yaml"
    task.write_text(TASK, "utf-8")
    return task


def test_an_infeasible_task_is_explained(slab: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", str(slab), "--explain", "0.2", "--workers", "1", "--json", "-", "--quiet"]) == 3
    result = json.loads(capsys.readouterr().out)
    assert result["verdict"] == "infeasible"
    reasons = result["reasons"]
    assert {r["kind"] for r in reasons} == {"contact", "joint limit", "region"}
    possible = [r["name"] for r in reasons if r["verdict"] == "solved"]
    assert possible == ["index/tip - front", "thumb/tip - back"], "each finger reaches its own face"


def test_a_feasible_task_needs_no_explanation(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "upholding", "--first", "--explain", "0.2", "--json", "-", "--quiet"]) == 0
    assert json.loads(capsys.readouterr().out)["reasons"] == []
