"""Pages of the documentation that are made from the code."""

import runpy
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = runpy.run_path(str(DOCS / "generate.py"))["PAGES"]


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_what_the_code_makes_now(name: str) -> None:
    assert (DOCS / name).read_text("utf-8") == PAGES[name](), "run docs/generate.py"
