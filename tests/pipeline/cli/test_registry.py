"""Commands by name, their options, and the examples in their help."""

import argparse
import re
import shlex
import subprocess
import sys

import pytest
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import COMMANDS, GROUPS, find_command

EXAMPLES = [(name, line) for name, command in COMMANDS.items() for line, _ in command.options.EXAMPLES]


def test_no_command_is_in_two_groups() -> None:
    assert sum(len(group.commands) for group in GROUPS) == len(COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_the_module_that_does_it_and_examples_that_say_what_they_do(name: str) -> None:
    command = COMMANDS[name]
    assert callable(command.runs.main)
    assert command.options.EXAMPLES
    assert all(line and does for line, does in command.options.EXAMPLES)


@pytest.mark.parametrize(("name", "line"), EXAMPLES)
def test_every_example_of_help_is_a_line_of_its_command(
    name: str, line: str, tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(str(tmp_path))
    word, *words = shlex.split(line)
    found, rest = find_command(words)
    assert word == "holdfast" and found is COMMANDS[name]
    _, unknown = command_parser(found).parse_known_args(rest)
    assert not unknown


@pytest.mark.parametrize(
    ("words", "name", "rest"),
    [
        (["hands", "new", "x.yaml"], "hands new", ["x.yaml"]),
        (["hands", "newer"], "hands", ["newer"]),
        (["objects"], "objects", []),
        (["objects", "fit"], "objects fit", []),
        (["objects fit", "x.obj"], "objects fit", ["x.obj"]),
        (["fit"], None, ["fit"]),
        ([], None, []),
    ],
)
def test_a_command_of_two_words_goes_before_one_of_one(
    words: list[str], name: str | None, rest: list[str]
) -> None:
    found, left = find_command(words)
    assert (found and found.name, left) == (name, rest)


def test_a_value_that_begins_with_a_minus_sign_is_a_value() -> None:
    fit = command_parser(COMMANDS["objects fit"])
    assert fit.parse_args(["m.obj", "--at", "-0.01,-.2,0", "--radius", "1"]).at == (-0.01, -0.2, 0.0)
    assert command_parser(COMMANDS["show"]).parse_args(["m.obj", "--view", "-30,20"]).view == "-30,20"


def test_options_load_nothing_heavy() -> None:
    program = (
        "import sys; from holdfast.pipeline.cli.registry import COMMANDS; "
        "from holdfast.pipeline.cli.parsers import command_parser; "
        "[command_parser(command) for command in COMMANDS.values()]; "
        "print(*({'numpy', 'mujoco', 'pydantic', 'scipy', 'trimesh', 'numba'} & set(sys.modules)))"
    )
    finished = subprocess.run(
        [sys.executable, "-P", "-c", program], capture_output=True, text=True, check=True
    )
    assert finished.stdout.strip() == ""


def test_an_option_means_the_same_in_every_command() -> None:
    """As far as help shows it: a switch is a switch everywhere, and a value is of one kind."""
    kinds: dict[str, set[tuple[object, ...]]] = {}
    for command in COMMANDS.values():
        for action in command_parser(command)._actions:
            if action.help == argparse.SUPPRESS:
                continue
            for name in action.option_strings:
                # What is written is a file here and a folder there; both are what --out names.
                value = "PATH" if action.metavar in ("FILE", "DIR") else action.metavar
                kinds.setdefault(name, set()).add((action.nargs == 0, value, action.type is None))
    assert {name: found for name, found in kinds.items() if len(found) > 1} == {}


@pytest.mark.parametrize(
    ("words", "dest", "value", "note"),
    [
        (["clear", "g.json", "--margin", "0.002"], "clearance", 0.002, "--margin is called --clearance now"),
        (["run", "upholding", "--margin", "0.002"], "clearance", 0.002, "--margin is called --clearance now"),
        (["clear", "g.json", "--all"], "every_pair", True, "--all is called --every-pair now"),
        (["clear", "g.json"], "every_pair", False, ""),
        (["clear", "g.json"], "clearance", 0.0, ""),
    ],
)
def test_old_names_of_options_work_and_say_the_new_one(
    words: list[str], dest: str, value: object, note: str, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = command_parser(COMMANDS[words[0]]).parse_args(words[1:])
    assert getattr(arguments, dest) == value
    assert note in capsys.readouterr().err


@pytest.mark.parametrize("width", [50, 80, 200])
@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_is_no_wider_than_the_terminal(
    name: str, width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    assert main([*name.split(), "--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    # A command line of an example is copied whole.
    lines = [line for line in lines if not line.startswith("  holdfast ")]
    assert max(map(len, lines)) <= width


@pytest.mark.parametrize("name", ["", "run", "hold"])
def test_help_has_the_same_words_in_colours(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    assert main([*name.split(), "--help"]) == 0
    plain = capsys.readouterr().out
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert main([*name.split(), "--help"]) == 0
    coloured = capsys.readouterr().out
    assert "\x1b[" in coloured
    assert re.sub(r"\x1b\[[\d;]*m", "", coloured).split() == plain.split()
