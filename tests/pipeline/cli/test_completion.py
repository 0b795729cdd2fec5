"""Completion: what could stand next, and what the shells make of it."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from holdfast.pipeline.cli.completions import completions
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.cli.parsers import command_parser, long_options
from holdfast.pipeline.cli.registry import COMMANDS


def test_first_words_are_the_commands() -> None:
    assert {name.split()[0] for name in COMMANDS} <= set(completions([""]))
    assert completions(["sugg"]) == ["suggest"]
    assert completions(["--v"]) == ["--version"]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_completed_once(name: str) -> None:
    found = completions([*name.split(), "--"])
    shown = set(long_options(command_parser(COMMANDS[name])))
    assert len(found) == len(set(found)) and set(found) <= shown
    assert "--help" in found


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["run", "uphol"], ["upholding"]),
        (["run", "upholding", "--hand", "sha"], ["shadow"]),
        (["run", "--hand", "sa", "uphol"], ["upholding"]),
        (["hands", "n"], ["new"]),
        (["hands", "sha"], ["shadow"]),
        (["objects", "teap"], ["teapot"]),
        (["objects", "teapot", "scal"], []),
        (["solve", "upholding", "--order", "b"], ["breadth", "best"]),
        (["solve", "upholding", "--proof", ""], []),
        (["solve", "upholding", "--firs"], ["--first"]),
        (["solve", "upholding", "--first", "--firs"], []),
        (["clear", "--marg"], []),
        (["show", "teap"], ["teapot"]),
        (["nosuch", ""], []),
    ],
)
def test_words_that_could_stand_there(words: list[str], found: list[str]) -> None:
    assert completions(words) == found


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_for_each_shell_is_printed(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert "completion words" in script
    if program := shutil.which(shell):
        checked = subprocess.run([program, "-n"], input=script, capture_output=True, text=True, check=False)
        assert (checked.returncode, checked.stderr) == (0, "")


def test_bash_completes_by_the_script(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("no bash here")
    main(["completion", "bash"])
    program = tmp_path / "holdfast"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -P -m holdfast "$@"\n', "utf-8")
    program.chmod(0o755)
    script = f"""{capsys.readouterr().out}
COMP_WORDS=({program} solve upholding --order br) COMP_CWORD=4
_holdfast
printf '<%s>' "${{COMPREPLY[@]}}" """
    done = subprocess.run([bash, "-c", script], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("<breadth>", "")
