"""`holdfast show` draws whatever has a name, with its regions in their colours."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from holdfast.base.numeric.arrays import Picture
from holdfast.hands import load_hand
from holdfast.mjcf.render import colour_of, picture
from holdfast.objects import load_object, load_task
from holdfast.pipeline.cli.main import main
from PIL import Image

from ..conftest import TONGS

WIDTH, HEIGHT = 420, 300


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Rays are slow; what is drawn is the same on small panels."""
    monkeypatch.setattr(picture, "_PANEL", (WIDTH, HEIGHT))
    monkeypatch.setattr(picture, "_COLUMN_PX", 110)
    monkeypatch.chdir(tmp_path)


def shown(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[Path, Picture]:
    """The file that the command has written, and its picture."""
    assert main(["show", "--quiet", *words]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    path = Path(out.strip())
    return path, np.asarray(Image.open(path).convert("RGB"))


def coloured(drawn: Picture, number: int) -> int:
    """How many pixels have exactly the colour of a region's name."""
    return int((drawn == colour_of(number)).all(axis=-1).sum())


def test_an_object_is_drawn_from_two_sides(capsys: pytest.CaptureFixture[str]) -> None:
    path, drawn = shown(capsys, "scalpel")
    assert path == Path("scalpel_shown.png") and drawn.shape == (HEIGHT, 2 * WIDTH, 3)
    regions = load_object("scalpel").regions
    assert all(coloured(drawn, i) > 20 for i in range(len(regions)))
    assert coloured(drawn, len(regions)) == 0
    left, right = drawn[:, :WIDTH], drawn[:, WIDTH:]
    assert not np.array_equal(left[40:-60], right[40:-60])


def test_a_mesh_is_drawn_in_its_units(capsys: pytest.CaptureFixture[str]) -> None:
    trimesh.creation.box((30.0, 100.0, 20.0)).export("bar.stl")
    trimesh.creation.box((0.03, 0.1, 0.02)).export("small.stl")
    path, drawn = shown(capsys, "bar.stl", "--units", "mm")
    assert path == Path("bar_shown.png")
    same = shown(capsys, "small.stl")[1]
    # All but the title, which has the name.
    assert (drawn[30:] != same[30:]).any(axis=-1).mean() < 1e-3
    assert (drawn < 250).any(axis=-1).mean() > 0.05


def test_a_hand_is_drawn_whether_built_in_or_a_bare_model(capsys: pytest.CaptureFixture[str]) -> None:
    path, drawn = shown(capsys, "sa", "--out", "hand.png")
    assert path == Path("hand.png")
    # Small panels have no room for all names; no region has a colour that none of them has.
    count = len(load_hand("sa").regions)
    assert sum(coloured(drawn, i) > 0 for i in range(count)) > min(count, 8)
    Path("tongs.xml").write_text(TONGS, "utf-8")
    _, drawn = shown(capsys, "tongs.xml")
    found = len(load_hand("tongs.xml").regions)
    assert found > 0 and any(coloured(drawn, i) > 20 for i in range(found))


def test_a_task_is_drawn_as_hand_and_object_with_pairs_in_a_colour(
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, drawn = shown(capsys, "upholding")
    assert path == Path("upholding_shown.png") and drawn.shape == (HEIGHT, 2 * WIDTH, 3)
    for i in range(len(load_task("upholding").contacts)):
        assert coloured(drawn[:, :WIDTH], i) > 20 and coloured(drawn[:, WIDTH:], i) > 20


def test_a_grasp_is_drawn_from_the_side_that_is_asked_for(
    grasp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pictures = [
        shown(capsys, str(grasp_path), "--view", view, "--out", f"{i}.png")[1]
        for i, view in enumerate(("front", "180,0", "back", "30,-40"))
    ]
    assert {drawn.shape for drawn in pictures} == {(HEIGHT, WIDTH, 3)}
    assert np.array_equal(pictures[0], pictures[1]), "the front is at azimuth 180"
    assert len({drawn.tobytes() for drawn in pictures}) == 3
    assert all(coloured(pictures[0], i) > 20 for i in range(2))


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["scalpl"], "did you mean 'scalpel'"),
        (["upholdng"], "did you mean 'upholding'"),
        (["nothing.stl"], "nothing.stl"),
        (["nothing.json"], "nothing.json"),
        (["nothing.yaml"], "nothing.yaml"),
        (["nothing.urdf"], "nothing.urdf"),
        (["scalpel", "--view", "frnt"], "did you mean 'front'"),
        (["scalpel", "--view", "10,95"], "AZIMUTH,ELEVATION in degrees, not '10,95'"),
        (["scalpel", "--view", "nan,0"], "AZIMUTH,ELEVATION in degrees, not 'nan,0'"),
        (["scalpel", "--out", "scalpel.jpg"], "must end in .png"),
        (["scalpel", "--out", "taken/x.png"], "taken"),
        (["scalpel", "--scale", "2"], "--scale: goes with a mesh file; an object has its own"),
        (["sa", "--units", "mm"], "--units: goes with a mesh file; a hand has its own"),
    ],
)
def test_misuse_is_one_line(words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("taken").write_text("a file", "utf-8")
    assert main(["show", *words]) == 2
    out, err = capsys.readouterr()
    assert says in err and err.count("\n") == 1 and out == ""
    assert not list(Path().glob("*.png"))
