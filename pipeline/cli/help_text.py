"""How help looks: as wide as the terminal, in colours where it takes them."""

import argparse
import shutil
import sys
import textwrap
from collections.abc import Callable
from functools import partial

from ...base.text.terminal import has_colours
from .registry import Examples

__all__ = ["help_formatter", "help_width", "paragraphs", "shown_examples"]

_WIDEST, _NARROWEST = 100, 40
# The column at which what options do begins.
_OPTIONS_END = 28


def help_formatter() -> Callable[..., argparse.HelpFormatter]:
    """What lays out help for where stdout leads to."""
    layout: type[argparse.HelpFormatter] = argparse.RawDescriptionHelpFormatter
    if has_colours(sys.stdout):
        # Where nobody sees colours, nobody waits for this import.
        from .coloured_help import ColouredHelp

        layout = ColouredHelp
    return partial(layout, max_help_position=_OPTIONS_END, width=help_width())


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
