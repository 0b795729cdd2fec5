"""`holdfast verify` as a user types it: what is said, what is written, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.formats import read_grasps

from .made import GRIPPER

HAND, OBJECT = str(GRIPPER / "gripper.yaml"), str(GRIPPER / "block.yaml")
USUAL = ["--hand", HAND, "--object", OBJECT, "--no-hold", "--no-nearby"]


def isaac(path: Path, *, z: float = -0.09, joint: float = 0.01) -> str:
    """A file with the block between the pads, `joint` of each from its middle."""
    path.write_text(
        "format: isaac_grasp\nformat_version: 1.0\ngrasps:\n  first:\n    confidence: 1.0\n"
        f"    position: [0.0, 0.0, {z}]\n"
        "    orientation: {w: 1.0, xyz: [0.0, 0.0, 0.0]}\n"
        f"    cspace_position: {{left_slide: {-joint}, right_slide: {joint}}}\n",
        "utf-8",
    )
    return str(path)


def test_a_sound_grasp_has_nothing_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", isaac(tmp_path / "g.yaml"), *USUAL, "--frame", "base", "--json", "-"]) == 0
    shown = capsys.readouterr()
    record = json.loads(shown.out)
    assert record["summary"] == {
        "grasps": 1,
        "sound": 1,
        "certified_nearby": 0,
        "labels": {},
        "label_auc": None,
    }
    (grasp,) = record["grasps"]
    assert grasp["label"] is True and grasp["sound"] and grasp["faults"] == []
    assert {contact["finger"] for contact in grasp["contacts"]} == {"left", "right"}
    assert "isaac_grasp" in shown.err


def test_what_is_wrong_is_shown_in_the_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = isaac(tmp_path / "g.yaml", joint=0.008)
    assert main(["verify", file, *USUAL, "--frame", "base"]) == 4
    shown = " ".join(capsys.readouterr().out.split())
    assert "and object 2 mm deep" in shown and "0 of 1 grasps are sound" in shown


def test_a_page_and_certified_grasps_of_the_same_format_are_written(tmp_path: Path) -> None:
    file, out = isaac(tmp_path / "<b>g.yaml", joint=0.0095), tmp_path / "out"
    text = Path(file).read_text("utf-8")
    Path(file).write_text(text.replace("{left_slide", "{wrist: 0.0, left_slide"), "utf-8")
    words = ["verify", file, "--hand", HAND, "--object", OBJECT, "--no-hold", "--quiet", "--frame", "base"]
    assert main([*words, "--out", str(out)]) in (0, 4)
    page = (out / "verify.html").read_text("utf-8")
    assert "&lt;b&gt;g" in page and "<b>g" not in page
    # Lines that are said of the reading stand by themselves: a line's end inside of one is shown as a mark.
    lines = page.split('<div class="read">')[1].split("</div>")[0].strip().splitlines()
    assert all(line.startswith("<p>") and "?" not in line for line in lines)
    assert lines[1] == "<p>  joints that the hand lacks: wrist</p>"
    assert "default-src &#39;none&#39;" in page or "default-src 'none'" in page
    fixed = read_grasps(out / "fixed_isaac_grasp.yaml")
    (grasp,) = fixed.grasps
    assert grasp.grasp.joints is not None
    width = np.ptp([grasp.grasp.joints.by_name[name] for name in ("left_slide", "right_slide")])
    assert width == pytest.approx(0.02, abs=2.1e-4)


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--preset", "holdfst"], "did you mean 'holdfast'?"),
        (["--mass", "1"], "--mass: goes with a mesh"),
        (["--no-nearby", "--prove", "3"], "--no-nearby: excludes --prove"),
        (["--joint-order", "hand"], "--joint-order: makes no difference"),
        (["--frame", "nowhere"], "did you mean|known: base"),
    ],
)
def test_slips_are_answered_in_a_line(
    tmp_path: Path, more: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["verify", isaac(tmp_path / "g.yaml"), "--hand", HAND, "--object", OBJECT]
    assert main([*words, *more, *([] if "--preset" in more else ["--no-hold"])]) == 2
    error = capsys.readouterr().err
    assert any(part in error for part in says.split("|")), error
