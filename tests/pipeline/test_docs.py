"""The files that the documentation shows are read by the code, and the examples run."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from holdfast.objects import load_task
from holdfast.pipeline.cli.main import main
from holdfast.solver import solve

from .conftest import environment_for_subprocess

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def documented_task(tmp_path: Path) -> Path:
    """The task, object and hand files of docs/files.md."""
    blocks = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "files.md").read_text("utf-8"), re.S)
    names = [re.match(r"name: (\w+)", block) for block in blocks]
    for name, block in zip(names, blocks, strict=True):
        assert name is not None
        (tmp_path / f"{name[1]}.yaml").write_text(block, "utf-8")
    return tmp_path / "pinch.yaml"


def test_the_documented_files_make_a_solvable_task(documented_task: Path) -> None:
    task = load_task(documented_task)
    assert (task.name, task.hand.name, task.object.name) == ("pinch", "gripper", "bar")
    result = solve(task, candidates=2, budget_s=600.0)
    assert result.verdict.value == "solved" and all(c.certified for c in result.configurations)


@pytest.mark.slow  # compiles for half a minute where that has not been done
def test_the_documented_system_is_solved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"```json\n(.*?)```", (ROOT / "docs" / "files.md").read_text("utf-8"), re.S)
    path = tmp_path / "system.json"
    path.write_text(block, "utf-8")
    assert main(["system", str(path), "--json", "-", "--quiet"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["verdict"] == "complete" and len(result["solutions"]) == 2


@pytest.mark.slow
@pytest.mark.parametrize(("example", "argument"), [("own_task.py", "run"), ("grasp_choice.py", "5")])
def test_examples(example: str, argument: str, tmp_path: Path) -> None:
    finished = subprocess.run(
        [sys.executable, "-W", "error", str(ROOT / "examples" / example), argument],
        cwd=tmp_path,
        env=environment_for_subprocess(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr
    assert "held" in finished.stdout or "holds in" in finished.stdout
