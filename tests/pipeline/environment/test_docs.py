"""The Python blocks of the pages of environments and data sets run as they stand."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
BLOCKS = [
    pytest.param(block, id=f"{page}-{k}")
    for page in ("environment", "dataset")
    for k, block in enumerate(
        re.findall(r"```python\n(.*?)```", (ROOT / "docs" / f"{page}.md").read_text("utf-8"), re.S)
    )
]


def test_the_pages_have_examples() -> None:
    assert len(BLOCKS) >= 4


@pytest.mark.parametrize("block", BLOCKS)
def test_an_example_runs(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    import gymnasium
    import holdfast

    exec(compile(block, "docs", "exec"), {"gymnasium": gymnasium, "holdfast": holdfast})
    assert "Error" not in capsys.readouterr().out
