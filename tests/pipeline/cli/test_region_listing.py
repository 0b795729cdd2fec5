"""How regions lie on their bodies, as `objects` and `hands` list it, and what `solve` says of it."""

import json
from pathlib import Path

import pytest
from holdfast.pipeline.cli import main

FACE = [[[-0.01, -0.01, 0.01], [-0.01, 0.01, 0.01]], [[0.01, -0.01, 0.01], [0.01, 0.01, 0.01]]]
AIR = [[[x, y, 0.013] for x, y, _ in row] for row in FACE]
REGIONS = {
    "good": {"bezier": FACE},
    "in_the_air": {"bezier": AIR},
    "turned": {"bezier": FACE[::-1]},
    "tilted": {"bezier": [[[x, y, 0.01 + 0.06 * x] for x, y, _ in row] for row in FACE]},
    "meant": {"bezier": AIR, "off_surface": True},
    "back": {"bezier": [[[x, y, -z] for x, y, z in row] for row in FACE[::-1]]},
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    box = {"name": "box", "box": {"half_extents": [0.02, 0.03, 0.01]}, "mass": 0.1, "friction": 0.6}
    (tmp_path / "box.yaml").write_text(json.dumps({**box, "regions": REGIONS}))
    for name in REGIONS:
        contacts = [{"hand": "index/tip", "object": name}, {"hand": "thumb/tip", "object": "back"}]
        task = {"name": name, "hand": "sa", "object": "box.yaml", "contacts": contacts}
        (tmp_path / f"{name}.yaml").write_text(json.dumps(task))
    return tmp_path


def table(text: str, first: str) -> dict[str, list[str]]:
    """The rows of the table whose head begins with `first`, by their first cells."""
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(first))
    rows = [line.split(maxsplit=6) for line in lines[start + 2 :]]
    return {row[0]: row[1:] for row in rows[: rows.index([]) if [] in rows else None]}


def test_objects_lists_each_region_off_ones_too(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["objects", str(folder / "box.yaml")]) == 0
    rows = table(capsys.readouterr().out, "region")
    # kind, off the pieces, off the surface, at most, angle of the normals, what a task says
    assert rows["good"] == ["patch", "0.00", "0.00", "0.00", "0"]
    assert rows["in_the_air"] == ["patch", "3.00", "3.00", "3.00", "0", "refused"]
    assert rows["turned"] == ["patch", "0.00", "0.00", "0.00", "180", "refused"]
    assert rows["tilted"][3:] == ["0.60", "3", "partly off"]
    assert rows["meant"] == ["patch", "3.00", "3.00", "3.00", "0", "off, as meant"]


def test_hands_lists_each_region(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["hands", "sa"]) == 0
    rows = table(capsys.readouterr().out, "region")
    assert rows["index/tip"] == ["index_distal", "cap", "0.00", "0.00", "0"]
    assert all(float(row[2]) < 0.05 and float(row[4]) < 5 for row in rows.values())


@pytest.mark.parametrize(
    ("name", "words"), [("in_the_air", "3 mm off the surface of box"), ("turned", "turned inwards")]
)
@pytest.mark.parametrize("command", ["solve", "run", "tasks"])
def test_a_task_with_it_is_bad_input(
    folder: Path, name: str, words: str, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, str(folder / f"{name}.yaml")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and f"{name}.yaml: contacts.0.object: region {name!r}" in said
    assert words in said and "`off_surface: true`" in said


@pytest.mark.parametrize(("name", "gap_m"), [("good", 0.0), ("meant", 3e-3)])
def test_the_gap_on_record_is_that_of_the_bodies(
    folder: Path, name: str, gap_m: float, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", str(folder / f"{name}.yaml"), "--first", "--json", "-", "--quiet"]) == 0
    (solution,) = json.loads(capsys.readouterr().out)["solutions"]
    first, second = solution["contacts"]
    assert first["gap"] == pytest.approx(gap_m, abs=1e-6)
    assert second["gap"] == pytest.approx(0.0, abs=1e-6)
    assert max(first["region_gap"], second["region_gap"]) < 1e-9
