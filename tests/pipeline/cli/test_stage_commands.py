"""`solve`, `clear`, `hold`, `render` and `report` on what an earlier command wrote."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import RunRecord, read_grasp
from PIL import Image

from ..conftest import environment_for_subprocess


def test_solve_json_alone_on_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "upholding", "--candidates", "3", "--json", "-"]) == 0
    out, err = capsys.readouterr()
    result = json.loads(out)
    assert {"verdict", "seconds", "boxes", "lps", "sigma", "solutions"} <= result.keys()
    assert result["verdict"] == "solved" and len(result["solutions"]) == 3
    assert all(solution["certified"] for solution in result["solutions"])
    assert "solving upholding" in err


def test_solve_first_quiet_and_into_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "result.json"
    assert main(["solve", "scalpel/upholding", "--first", "--quiet", "--json", str(file)]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("upholding: solved; 1 configuration;") and err == ""
    assert len(json.loads(file.read_text("utf-8"))["solutions"]) == 1


def test_the_stages_one_by_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "upholding", "--first", "--out", str(tmp_path)]) == 0
    solved, cleared, held = tmp_path / "g01.json", tmp_path / "cleared.json", tmp_path / "held.json"
    capsys.readouterr()
    assert main(["clear", str(solved), "--out", str(cleared)]) == 0
    assert capsys.readouterr().out.startswith("g01: ")
    assert read_grasp(cleared).is_clear and read_grasp(solved).clearance is None
    code = main(["hold", str(cleared), "--out", str(held)])
    record = read_grasp(held)
    assert code == (0 if record.is_held else 4)
    assert record.clearance == read_grasp(cleared).clearance


def test_hold_says_what_the_run_said(
    grasp_path: Path, run_record: RunRecord, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["hold", str(grasp_path), "--json", "-"]) == 0
    again = json.loads(capsys.readouterr().out)
    best = run_record.grasps[0]
    assert best.hold is not None
    written = [d["slip"] for d in again["hold"]["directions"]]
    # The file holds the pose to the last bit but one.
    assert written == pytest.approx([d.slip for d in best.hold.directions], rel=1e-3)
    assert main(["hold", str(grasp_path)]) == 0
    assert "held in 6 of 6 directions" in capsys.readouterr().out


def test_another_task_may_be_given(grasp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["clear", str(grasp_path), "--task", "scalpel/upholding"]) == 0
    assert main(["clear", str(grasp_path), "--task", "uphold"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_render_names_its_pictures(
    grasp_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], small_pictures: None
) -> None:
    assert main(["render", str(grasp_path), "--out", str(tmp_path / "pictures")]) == 0
    paths = capsys.readouterr().out.split()
    assert len(paths) == 6  # four sides, the film and the video
    for path in paths:
        with Image.open(path) as image:
            assert image.size[0] > 0 and len(set(image.convert("L").tobytes())) > 10


def test_report_elsewhere(run_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "page.html"
    assert main(["report", str(run_path), "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}\n"
    # The same page, whose links to the grasps' files count from where it lies.
    text, pattern = out.read_text("utf-8"), r'href="([^"#][^"]*)"'
    links = re.findall(pattern, text)
    assert links and all((tmp_path / link).resolve().is_relative_to(run_path.resolve()) for link in links)
    moved = re.sub(pattern, "", text)
    assert moved == re.sub(pattern, "", (run_path / "report.html").read_text("utf-8"))


def test_control_characters_of_a_file_do_not_reach_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "task.yaml"
    path.write_text('name: "a\\e[31m\\nb"\nhand: sa\nobject: scalpel\ncontacts: []\n', "utf-8")
    assert main(["tasks", str(path)]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "\x1b" not in err


# The signal that a person sends, once so much is found, however slow the machine is.
INTERRUPTED_AFTER_THREE = """
import os, signal, sys
from holdfast.base.text.console import Console
from holdfast.pipeline.cli import main

def pass_by(console, text):
    if text.split()[0] == "3":
        os.kill(os.getpid(), signal.SIGINT)

Console.pass_by = pass_by
"""


@pytest.mark.parametrize("command", ["run", "solve"])
def test_an_interrupt_keeps_what_was_found(command: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = [command, "upholding", "--candidates", "100000", "--out", str(out)]
    program = f"{INTERRUPTED_AFTER_THREE}\nsys.exit(main({words!r}))"
    process = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env=environment_for_subprocess()
    )
    said, err = process.stdout, process.stderr
    assert process.returncode == 130, err
    assert "Traceback" not in err
    assert "solving upholding" in err
    assert "stopping; what is finished is kept" in err
    found = re.search(r"(\d+) configurations|of (\d+) grasps", said)
    assert found is not None
    if command == "run":
        assert "incomplete" in said and (out / "run.json").exists() and (out / "report.html").exists()
    else:
        assert len(list(out.glob("*.json"))) == int(found[1]) > 0
