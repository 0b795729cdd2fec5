"""How help looks: as wide as the terminal, in colours where it takes them."""

import argparse
import shutil
import sys
import textwrap

from ...base.text.terminal import has_colours
from .registry import Examples

__all__ = ["help_formatter", "help_width", "paragraphs", "shown_examples"]

_WIDEST, _NARROWEST = 100, 40


class _Plain(argparse.RawDescriptionHelpFormatter):
    """Help for files and pipes, and for terminals without colours."""

    def __init__(self, prog: str):
        super().__init__(prog, max_help_position=28, width=help_width())


def help_formatter() -> type[argparse.HelpFormatter]:
    """The class that lays out help for where stdout leads to."""
    if not has_colours(sys.stdout):
        return _Plain
    # Where nobody sees colours, nobody waits for this import.
    from .coloured_help import ColouredHelp

    return ColouredHelp


def paragraphs(*texts: str) -> str:
    """Texts over and under the options, wrapped."""
    return "\n".join(textwrap.fill(text, help_width(), break_on_hyphens=False) for text in texts)


def shown_examples(examples: Examples) -> str:
    """Examples, each with what it does beside it, or below it where that is too wide."""
    wide = max(len(line) for line, _ in examples)
    beside = all(wide + len(does) + 6 <= help_width() for _, does in examples)
    if beside:
        lines = [f"  {line:<{wide}}  # {does}" for line, does in examples]
    else:
        lines = [f"{_remark(does)}\n  {line}" for line, does in examples]
    return "\n".join(["examples:", *lines])


def _remark(does: str) -> str:
    return textwrap.fill(does, help_width(), initial_indent="  # ", subsequent_indent="  # ")


def help_width() -> int:
    """Columns that help may take."""
    return max(_NARROWEST, min(_WIDEST, shutil.get_terminal_size().columns - 2))
