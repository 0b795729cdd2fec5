"""Writes the pages of the documentation that are made from the code; a test holds them up to date.

`python docs/generate.py` writes them beside this file.
"""

import argparse
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

from holdfast.pipeline.cli.parsers import command_parser
from holdfast.pipeline.cli.registry import GROUPS, Command

HERE = Path(__file__).resolve().parent
WIDTH = 118
TITLES = {"positional arguments": "arguments"}
MADE = "<!-- Made from the code by docs/generate.py. -->"


def commands_page() -> str:
    """Every command with its arguments, options and examples."""
    lines = ["# Commands", "", MADE, ""]
    lines += wrapped(
        "What each command takes, from the program itself: `holdfast COMMAND --help` says the same. "
        "What they have in common, exit codes and variables: [the command line](command-line.md)."
    )
    for group in GROUPS:
        if not group.commands:
            continue
        lines += ["", f"## {group.title[0].upper()}{group.title[1:]}"]
        for name, summary in group.commands.items():
            lines += ["", f"### `{name}`", "", *command_lines(Command(name, summary, group.folder))]
    return "\n".join(lines) + "\n"


def command_lines(command: Command) -> Iterator[str]:
    """A command's section."""
    parser = command_parser(command)
    yield from wrapped(f"{command.summary[0].upper()}{command.summary[1:]}.")
    yield ""
    yield "```sh"
    for line, does in command.options.EXAMPLES:
        yield f"# {does}"
        yield line
    yield "```"
    for group in parser._action_groups:
        shown = [a for a in group._group_actions if a.help != argparse.SUPPRESS and a.dest != "help"]
        if not shown:
            continue
        yield ""
        title = TITLES.get(group.title or "", group.title or "")
        yield f"{title[0].upper()}{title[1:]}:"
        yield ""
        for action in shown:
            yield from wrapped(f"- {invocation(action)}: {action.help}", "  ")


def invocation(action: argparse.Action) -> str:
    """How an argument or option is written."""
    if not action.option_strings:
        return f"`[{action.metavar}]`" if action.nargs == "?" else f"`{action.metavar}`"
    names = ", ".join(action.option_strings)
    return f"`{names}`" if action.nargs == 0 else f"`{names} {action.metavar}`"


def wrapped(text: str, indent: str = "") -> list[str]:
    """Text in lines that are short enough."""
    return textwrap.wrap(
        text, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


PAGES: dict[str, Callable[[], str]] = {"commands.md": commands_page}


def main() -> None:
    """Writes all of them."""
    for name, make in PAGES.items():
        (HERE / name).write_text(make(), "utf-8")


if __name__ == "__main__":
    main()
