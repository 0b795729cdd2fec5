"""Parsers of the command line, each built when its command is asked for."""

import argparse
import re
from typing import Any, NoReturn

from ... import __version__
from ...errors import HoldfastError
from .help_text import help_formatter, paragraphs, shown_examples
from .registry import GROUPS, Command

__all__ = ["UsageError", "command_parser", "long_options", "top_parser"]

_EXIT_CODES = "exit codes: 0 found, 2 bad usage or input, 3 proved infeasible, 4 neither, 130 interrupted"


class UsageError(HoldfastError):
    """Something on the command line that makes no sense."""


class _Parser(argparse.ArgumentParser):
    """A parser that raises where argparse would print its usage and exit."""

    def __init__(self, **more: Any):
        super().__init__(formatter_class=help_formatter(), allow_abbrev=False, **more)
        # A value may be a point or an angle, such as -0.01,0,0.02, and not a number alone.
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{self.prog.removeprefix('holdfast ')}: {message}")


def top_parser() -> argparse.ArgumentParser:
    """The parser of what comes without a command; its help lists the commands."""
    parser = _Parser(
        prog="holdfast",
        usage="holdfast [-h] [-V] COMMAND ...",
        description=paragraphs(
            "Grasps with specified contact regions: certified, penetration-free, held in simulation."
        ),
        epilog=paragraphs(
            _EXIT_CODES,
            "`holdfast COMMAND --help` shows a command's options, with examples; "
            "`holdfast completion --help` how the shell completes them.",
        ),
    )
    parser.add_argument("-V", "--version", action="version", version=f"holdfast {__version__}")
    for group in filter(lambda group: group.commands, GROUPS):
        listed = parser.add_argument_group(group.title)
        # Shown with the group, and not parsed: the parser of a command is built when it is asked for.
        listed._group_actions += [_Listed(name, summary) for name, summary in group.commands.items()]
    return parser


def command_parser(command: Command) -> argparse.ArgumentParser:
    """The parser of the words after a command."""
    options = command.options
    parser = _Parser(
        prog=f"holdfast {command.name}",
        description=paragraphs(f"{command.summary[0].upper()}{command.summary[1:]}."),
        epilog=shown_examples(options.EXAMPLES),
    )
    parser.set_defaults(command=command.name)
    options.add_options(parser)
    return parser


def long_options(parser: argparse.ArgumentParser) -> list[str]:
    """The options that help shows, by their names with two dashes."""
    shown = (action for action in parser._actions if action.help != argparse.SUPPRESS)
    return [name for action in shown for name in action.option_strings if name.startswith("--")]


class _Listed(argparse.Action):
    """A line of help."""

    def __init__(self, name: str, summary: str):
        super().__init__([], dest=name, nargs=0, metavar=name, help=summary)

    def __call__(self, *words: object) -> NoReturn:
        raise AssertionError("this is help, and no option")
