"""The site: built without a warning and without a network, and it asks no other site for anything."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built as `./run docs` builds it."""
    folder = tmp_path_factory.mktemp("site")
    # Nothing answers there.
    nowhere = dict.fromkeys(("http_proxy", "https_proxy"), "http://127.0.0.1:9")
    words = ["-P", "-m", "mkdocs", "build", "--strict", "--config-file", str(ROOT / "mkdocs.yml")]
    done = subprocess.run(
        [sys.executable, *words, "--site-dir", str(folder)],
        env={**os.environ, **nowhere, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_is_built(site: Path) -> None:
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}
    assert pages <= {path.stem for path in site.glob("*.html")}


def test_pages_load_nothing_from_elsewhere(site: Path) -> None:
    loaded = re.compile(r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=[\"']?(https?:)?//", re.IGNORECASE)
    pages = list(site.glob("*.html"))
    assert len(pages) > 20
    assert [page.name for page in pages if loaded.search(page.read_text("utf-8"))] == []


def test_every_page_has_a_place_in_the_navigation() -> None:
    text = (ROOT / "mkdocs.yml").read_text("utf-8").partition("\nnav:")[2]
    assert {f"{path.name}" for path in (ROOT / "docs").glob("*.md")} == set(re.findall(r"[\w-]+\.md", text))


def test_every_picture_of_the_documentation_is_small_and_used() -> None:
    text = "".join(path.read_text("utf-8") for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
    for path in (ROOT / "docs" / "images").rglob("*.png"):
        assert path.stat().st_size < 300_000, path.name
        assert f"images/{path.relative_to(ROOT / 'docs' / 'images').as_posix()}" in text, path.name
