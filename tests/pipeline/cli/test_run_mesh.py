"""`holdfast run MESH`."""

from pathlib import Path

import pytest
import trimesh
from holdfast.pipeline.cli import main


@pytest.fixture
def can(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))
    monkeypatch.chdir(tmp_path)
    trimesh.creation.cylinder(0.025, 0.08, sections=32).export("can.obj")
    (tmp_path / "box.yaml").write_text("{box: {half_extents: [0.02, 0.03, 0.01]}, mass: 0.1, friction: 0.6}")
    return tmp_path


def test_one_command_from_a_mesh_to_a_held_grasp(can: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [
        "run",
        "can.obj",
        "--mass",
        "0.2",
        "--candidates",
        "2",
        "--budget",
        "600",
        "--workers",
        "1",
        "--quiet",
    ]
    assert main(words) == 0
    printed = capsys.readouterr().out
    assert "certified, clear and held" in printed
    assert (can / "runs" / "can_sa" / "report.html").is_file()
    assert (can / "runs" / "can_sa_task" / "can.yaml").is_file()


def test_contacts_are_looked_for_on_an_object_file_too(can: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "box.yaml", "--candidates", "1", "--budget", "600", "--quiet"]) == 0
    assert "box_index_thumb_1: solved" in capsys.readouterr().out
    assert [path.name for path in (can / "box_task").iterdir()] == ["box_index_thumb_1.yaml"]


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        (["run", "upholding", "--mass", "1"], "--mass: goes with a mesh file"),
        (["run", "upholding", "--contacts", "2"], "--contacts: goes with an object"),
        (["run", "box.yaml", "--mass", "1"], "box.yaml has mass of its own"),
        (["run", "cann.obj"], "'cann.obj': no such file"),
        (["run", "can.obj", "--mass", "-1"], "--mass"),
        (["run", "can.obj", "--hand", "sx"], "unknown hand 'sx'"),
    ],
)
def test_slips_are_answered_in_a_line(
    can: Path, words: list[str], answer: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    assert answer in capsys.readouterr().err
    assert not (can / "runs").exists()
