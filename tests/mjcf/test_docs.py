"""The Python examples of the pages on retraction and the hold test run."""

import re
from pathlib import Path

import holdfast
import pytest

DOCS = Path(holdfast.__file__).parent / "docs"


@pytest.mark.parametrize(
    ("page", "beginnings"),
    [("retraction", ("clear", "not clear", "reachable")), ("hold", ("squeeze of", "held in", "not held"))],
)
def test_the_example_runs(page: str, beginnings: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"```python\n(.*?)```", (DOCS / f"{page}.md").read_text("utf-8"), re.DOTALL)
    exec(compile(block, f"{page}.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2
    assert all(line.startswith(beginnings) for line in lines)
