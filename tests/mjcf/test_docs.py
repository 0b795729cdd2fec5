"""The Python examples of the pages on retraction and the hold test run, one after the other."""

import re
from pathlib import Path

import holdfast
import pytest

DOCS = Path(holdfast.__file__).parent / "docs"
PAGES = {
    "retraction": [("clear", "not clear", "reachable")],
    "hold": [("squeeze of", "held in", "not held"), ("thumb", "index", "middle", "ring", "0", "1", "None")],
}


@pytest.mark.parametrize("page", PAGES)
def test_the_examples_run(page: str, capsys: pytest.CaptureFixture[str]) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / f"{page}.md").read_text("utf-8"), re.DOTALL)
    names: dict[str, object] = {}
    for block, beginnings in zip(blocks, PAGES[page], strict=True):
        exec(compile(block, f"{page}.md", "exec"), names)
        lines = capsys.readouterr().out.splitlines()
        assert len(lines) >= 2
        assert all(line.startswith(beginnings) for line in lines)
