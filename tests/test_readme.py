"""The README's examples, run as they stand."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text("utf-8")


def block_after(words: str, language: str) -> str:
    """The first fenced block of a language after some words of the README."""
    start = README.index(words)
    match = re.search(rf"```{language}\n(.*?)```", README[start:], re.DOTALL)
    assert match is not None
    return match.group(1)


def holdfast(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-m", "holdfast", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def without_seconds(text: str) -> str:
    """The text without what the machine decides: seconds, and radii of a few units in the last place."""
    return re.sub(r"\d\.\de-1[5-7]\b", "#e-16", re.sub(r"\d+\.\d+ s\b", "# s", text))


def test_the_system_example_prints_what_the_readme_says(tmp_path: Path) -> None:
    (tmp_path / "circle.json").write_text(block_after("With `circle.json` as", "json"), "utf-8")
    shown = block_after("it isolates all real solutions", "console")
    command, _, expected = shown.partition("\n")
    assert command == "$ holdfast system circle.json"
    done = holdfast("system", "circle.json", folder=tmp_path)
    assert done.returncode == 0
    assert without_seconds(done.stdout).strip() == without_seconds(expected).strip()


def test_the_python_example_prints_what_the_readme_says(tmp_path: Path) -> None:
    code = block_after("From Python:", "python")
    done = subprocess.run(
        [sys.executable, "-P", "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout == block_after("From Python:", "text")


@pytest.fixture
def own_files(tmp_path: Path) -> Path:
    for name in ("box.yaml", "pinch.yaml"):
        (tmp_path / name).write_text(block_after(f"`{name}`:", "yaml"), "utf-8")
    return tmp_path


def test_the_readers_own_object_is_held(own_files: Path) -> None:
    shown = block_after("`pinch.yaml`:", "console").splitlines()
    done = holdfast(*shown[0].removeprefix("$ holdfast ").split(), folder=own_files)
    assert done.returncode == 0, done.stderr
    assert without_seconds(done.stdout.splitlines()[0]) == without_seconds(shown[1])
    assert (own_files / "runs" / "pinch" / "report.html").is_file()


def test_a_slip_of_the_pen_is_answered_as_the_readme_says(own_files: Path) -> None:
    task = own_files / "pinch.yaml"
    task.write_text(task.read_text("utf-8").replace("object: back", "object: bakc"), "utf-8")
    done = holdfast("run", "pinch.yaml", folder=own_files)
    quoted = re.search(r"`(pinch\.yaml: .*?)`", README, re.DOTALL)
    assert quoted is not None
    assert done.returncode == 2
    assert done.stderr.strip() == f"holdfast: {' '.join(quoted.group(1).split())}"


def test_the_table_of_tasks_is_that_of_the_results_on_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "benchmarks")
    bench = runpy.run_path(str(ROOT / "benchmarks" / "whole_runs" / "tasks.py"))
    results = bench["results_on_file"]()
    assert [result.task for result in results] == list(bench["TASKS"])
    assert bench["readme_with"](README, results) == README


def test_links_of_the_readme_lead_somewhere() -> None:
    targets = re.findall(r"\]\(([^)#]+)\)", README)
    assert targets
    assert [t for t in targets if not (ROOT / t).exists()] == []
