"""Tables and colours on terminals of any width."""

import io
import re
import sys

import pytest
from holdfast.base.text import console
from holdfast.base.text.terminal import has_colours, painted
from holdfast.base.text.text_table import format_table

HEAD = ("name", "what it does", "n")
ROWS = [("upholding", "pick a scalpel up with index finger and thumb, slowly", "12"), ("x", "y", "-")]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("width", range(20, 90, 5))
def test_a_table_is_as_narrow_as_it_is_asked_for_and_loses_no_word(width: int) -> None:
    wide, folded = format_table(HEAD, ROWS), format_table(HEAD, ROWS, width)
    widest = max(map(len, folded.splitlines()))
    # Names of columns and numbers are not broken, and words keep a dozen letters.
    assert widest <= max(width, len("upholding") + 2 + 12 + 2 + 2)
    assert sorted(re.findall(r"[\w,]+", folded)) == sorted(re.findall(r"[\w,]+", wide))
    if width >= max(map(len, wide.splitlines())):
        assert folded == wide


def test_a_word_longer_than_its_column_is_broken_and_not_lost() -> None:
    folded = format_table(("path", "n"), [("a/" * 40, "1")], 30)
    assert max(map(len, folded.splitlines())) <= 30
    assert "".join(line.split()[0] for line in folded.splitlines()[2:]) == "a/" * 40


def test_a_table_on_a_terminal_has_its_width(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setattr(sys, "stdout", Terminal())
    assert max(map(len, console.format_table(HEAD, ROWS).splitlines())) <= 40
    monkeypatch.setattr(sys, "stdout", io.StringIO())
    assert console.format_table(HEAD, ROWS) == format_table(HEAD, ROWS)


@pytest.mark.parametrize(
    ("stream", "variables", "coloured"),
    [
        (Terminal(), {}, True),
        (Terminal(), {"NO_COLOR": "1"}, False),
        (Terminal(), {"NO_COLOR": ""}, True),
        (Terminal(), {"TERM": "dumb"}, False),
        (io.StringIO(), {}, False),
    ],
)
def test_colours_are_for_terminals_that_want_them(
    stream: io.StringIO, variables: dict[str, str], coloured: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert has_colours(stream) == coloured
    monkeypatch.setattr(sys, "stdout", stream)
    console.emit("mine: held; 3 of 3")
    assert ("\x1b" in stream.getvalue()) == coloured


@pytest.mark.parametrize(
    ("line", "colour"),
    [
        ("mine: held; 3 of 3", 32),
        ("mine: not held; 0 of 3", 31),
        ("g01: not held in 2 of 6 directions", 31),
        ("mine: infeasible; 0", 31),
        ("mine: undecided; 0", 33),
        ("accepted: mine is infeasible", 32),
        ("rejected: no", 31),
        ("complete: 2 certified solutions", 32),
        ("a sentence that says held: nothing", None),
    ],
)
def test_verdicts_have_colours_and_the_same_words(line: str, colour: int | None) -> None:
    shown = painted(line)
    assert re.sub(r"\x1b\[\d*m", "", shown) == line
    assert re.findall(r"\x1b\[(\d+)m", shown) == ([] if colour is None else [str(colour), "0"])


def test_the_head_of_a_table_stands_out() -> None:
    first, second, *rest = painted(format_table(HEAD, ROWS)).splitlines()
    assert first.startswith("\x1b[1m") and second.startswith("\x1b[2m") and "\x1b" not in "".join(rest)
