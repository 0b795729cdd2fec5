"""Snippets of the documentation: command lines that are understood, and pages that run from top to bottom."""

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import find_command

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
# Pages that a reader follows step by step, in an empty folder.
WALKED = ("start", "tutorial-mesh", "tutorial-hand", "howto")
_MOST_S = 900


class Block(NamedTuple):
    """A fenced block."""

    language: str
    title: str
    text: str


def blocks(path: Path) -> Iterator[Block]:
    found = re.findall(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```", path.read_text("utf-8"), re.S | re.M)
    return (Block(*block) for block in found)


def command_lines(path: Path) -> Iterator[str]:
    """Lines of a page, in blocks and indented, that call the command."""
    for line in path.read_text("utf-8").splitlines():
        shown = re.match(r"(?:    |\$ |    \$ )?(holdfast [a-z].*)$", line)
        if shown and not line.startswith("holdfast says"):
            yield shown[1].partition("  #")[0].rstrip()


LINES = sorted({(path.name, line) for path in PAGES for line in command_lines(path)})


@pytest.mark.parametrize(("page", "line"), LINES)
def test_command_lines_of_the_documentation_are_understood(
    page: str, line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = shlex.split(line, comments=True)[1:]
    if words[0] == "COMMAND" or not words[0].islower():
        return
    command, rest = find_command(words)
    assert command is not None, f"{page}: {line}"
    _, unknown = command_parser(command).parse_known_args([word for word in rest if word != ">"])
    assert not unknown or ">" in rest, f"{page}: {line}"


def test_walked_pages_have_steps() -> None:
    for name in WALKED:
        assert sum(block.language == "sh" for block in blocks(ROOT / "docs" / f"{name}.md")) >= 3


@pytest.mark.slow
@pytest.mark.parametrize("name", WALKED)
def test_a_page_runs_from_top_to_bottom(name: str, tmp_path: Path) -> None:
    environment = {**os.environ, "HOLDFAST_CACHE": os.environ.get("HOLDFAST_CACHE", str(tmp_path / "cache"))}
    for block in blocks(ROOT / "docs" / f"{name}.md"):
        if block.title:
            (tmp_path / block.title).write_text(block.text, "utf-8")
        elif block.language == "python":
            run([sys.executable, "-P", "-c", block.text], tmp_path, environment)
        elif block.language == "sh":
            for line in block.text.splitlines():
                words = shlex.split(line, comments=True)
                if words:
                    assert words[0] == "holdfast"
                    run([sys.executable, "-P", "-m", *words], tmp_path, environment)


def run(words: list[str], folder: Path, environment: dict[str, str]) -> None:
    done = subprocess.run(
        words, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=_MOST_S
    )
    assert done.returncode == 0, f"{words[3:]}: {done.stdout[-500:]} {done.stderr[-500:]}"
