"""Commands by name, their options, and the examples in their help."""

import shlex
import subprocess
import sys

import pytest
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
