"""The examples of docs/python.md, run as they stand."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python.md"
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


@pytest.mark.parametrize(
    "number",
    [pytest.param(i, marks=pytest.mark.slow if ".stl" in code else ()) for i, code in enumerate(EXAMPLES)],
)
def test_an_example_runs_and_leaves_its_files(number: int, tmp_path: Path) -> None:
    code = EXAMPLES[number]
    done = subprocess.run(
        [sys.executable, "-P", "-W", "error", "-c", code],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for name in re.findall(r'save\("(.*?)"', code):
        assert (tmp_path / name).is_file()
    for folder in re.findall(r'hf\.run\(".*?", "(.*?)"', code):
        assert re.match(r"held \[?True", done.stdout)
        assert (tmp_path / folder / "report.html").is_file()


def test_the_page_has_its_examples() -> None:
    assert len(EXAMPLES) == 3
