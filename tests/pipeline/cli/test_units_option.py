"""`run MESH --units --scale`: the object that is written has them, and what can't be is refused."""

from pathlib import Path

import pytest
import trimesh
from holdfast.objects import load_object
from holdfast.pipeline.cli import main


@pytest.fixture
def mesh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    trimesh.creation.box(extents=[4.0, 6.0, 2.0]).export(tmp_path / "box.stl")
    return tmp_path / "box.stl"


def test_the_object_file_has_the_units_of_its_mesh(mesh: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [
        "run",
        str(mesh),
        "--units",
        "cm",
        "--scale",
        "0.5",
        "--budget",
        "0.001",
        "--quiet",
        "--save",
        "task",
    ]
    assert main(words) == 4
    assert "warning" not in capsys.readouterr().err
    text = Path("task/box.yaml").read_text("utf-8")
    assert "units: cm" in text and "scale: 0.5" in text
    assert load_object("task/box.yaml").mesh.extents == pytest.approx([0.02, 0.03, 0.01])


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["box.stl", "--units", "inch"], "unknown unit of length 'inch'; did you mean 'in'?"),
        (["box.stl", "--scale", "0"], "--scale: must be a number above 0"),
        (["upholding", "--units", "mm"], "--units: goes with a mesh file"),
        (["upholding", "--scale", "2"], "--scale: goes with a mesh file"),
    ],
)
@pytest.mark.usefixtures("mesh")
def test_units_that_can_not_be(words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", *words]) == 2
    said = capsys.readouterr().err
    assert says in said and said.count("\n") == 1
