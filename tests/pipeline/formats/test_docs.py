"""docs/grasp-files.md: its example does what it prints, and its tables name what there is."""

import contextlib
import io
import re
from pathlib import Path

import holdfast
from holdfast.pipeline.formats import FORMATS, QUESTIONS

from . import made

TEXT = (Path(holdfast.__file__).parent / "docs" / "grasp-files.md").read_text("utf-8")


def test_the_example_prints_what_is_printed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("theirs.json").write_bytes(made.as_json(made.graspgen()))
    code = re.search(r"```python\n(.*?)```", TEXT, re.DOTALL)[1]
    printed = re.search(r"```text\n(.*?)```", TEXT, re.DOTALL)[1]
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(code, "docs/grasp-files.md", "exec"), {})
    assert out.getvalue() == printed


def test_the_tables_name_every_format_and_question():
    section = TEXT.partition("## What is read")[2].partition("## What is left open")
    assert re.findall(r"^\| `(\w+)` \|", section[0], re.MULTILINE) == list(FORMATS)
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*?) \|", section[2].partition("## ")[0], re.MULTILINE))
    assert set(rows) == set(QUESTIONS)
    for name, answers in QUESTIONS.items():
        assert re.findall(r"`(\w+)`", rows[name]) == list(answers)
