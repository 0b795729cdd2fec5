"""What could stand next on a command line."""

import argparse
from collections.abc import Iterator, Sequence

from .catalogue import KINDS, entries
from .parsers import command_parser, top_parser
from .registry import COMMANDS, find_command

__all__ = ["completions"]

# Kinds of what is built in that an argument takes, by what help calls it.
_TAKES = {"TASK": ("task",), "HAND": ("hand",), "OBJECT": ("object",)}
_NAME_TAKES = {"show": tuple(KINDS), "edit": ("object", "task"), "objects": ("object",), "hands": ("hand",)}


def completions(words: Sequence[str]) -> list[str]:
    """What could stand in place of the last word, in the order of help; nothing where a file is asked for.

    Args:
        words: those after `holdfast`, up to the one to complete, which may be empty.
    """
    *before, start = words or [""]
    return list(dict.fromkeys(word for word in _all(before) if word.startswith(start)))


def _all(before: list[str]) -> Iterator[str]:
    command, given = find_command(before)
    yield from _second_words(before)
    if command is None:
        if not before:
            yield from (name.partition(" ")[0] for name in COMMANDS)
            yield from _names(top_parser(), [])
        return
    parser = command_parser(command)
    option = parser._option_string_actions.get(given[-1]) if given else None
    if option is not None and option.nargs != 0:
        yield from _values(option, command.name)
        return
    for position in parser._get_positional_actions()[_count_positions(parser, given) :][:1]:
        yield from _values(position, command.name)
    yield from _names(parser, given)


def _second_words(before: list[str]) -> Iterator[str]:
    """Of commands with two words."""
    if len(before) == 1:
        yield from (name.partition(" ")[2] for name in COMMANDS if name.startswith(f"{before[0]} "))


def _names(parser: argparse.ArgumentParser, given: Sequence[str]) -> Iterator[str]:
    """The options that help shows, unless they were given."""
    for action in parser._actions:
        if action.help != argparse.SUPPRESS and not set(action.option_strings) & set(given):
            yield from action.option_strings


def _values(action: argparse.Action, command: str) -> Iterator[str]:
    if action.choices is not None:
        yield from map(str, action.choices)
        return
    name = str(action.metavar)
    for kind in (
        _NAME_TAKES.get(command, ("task",))
        if name == "NAME" and action.dest == "name"
        else _TAKES.get(name, ())
    ):
        yield from (entry.name for entry in entries(kind))


def _count_positions(parser: argparse.ArgumentParser, given: Sequence[str]) -> int:
    """How many arguments there are already."""
    count, is_value = 0, False
    for word in given:
        action = parser._option_string_actions.get(word)
        count += not is_value and action is None and not word.startswith("--")
        is_value = action is not None and action.nargs != 0
    return count
