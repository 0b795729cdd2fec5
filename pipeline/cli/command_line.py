"""The command line: what the user typed, which command does it, and what the exit code says.

Exit codes: 0 found; 2 bad usage or input, with one line on stderr; 3 proved infeasible; 4 neither;
130 interrupted, and what was found is kept.
"""

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from ...base.machine.backend import expect_choice
from ...base.machine.compile_clock import when_compiling
from ...base.machine.platform_check import require_supported_platform
from ...base.text.console import Console, mend_streams
from ...base.text.plain_text import one_line, printable, shortened
from ...base.text.spelling import nearest_name
from ...errors import HoldfastError, InputError, InputWarning, suggest
from .interrupt import INTERRUPTED, interrupting
from .parsers import UsageError, command_parser, long_options, top_parser
from .place import in_place
from .registry import COMMANDS, Command, find_command

__all__ = ["BAD_INPUT", "run_command"]

BAD_INPUT = 2
_LONGEST_ERROR = 1600
_LONGEST_WORD = 64
# What other programs call an option of ours.
_ELSEWHERE = {
    **dict.fromkeys(("--timeout", "--time-limit", "--max-time"), "--budget"),
    **dict.fromkeys(("--jobs", "-j", "--threads", "--processes", "--cores", "--parallel"), "--workers"),
    **dict.fromkeys(("--samples", "--grasps", "--number", "-n"), "--candidates"),
    **dict.fromkeys(("--overwrite", "-f"), "--force"),
    **dict.fromkeys(("--dest", "--folder", "-o"), "--out"),
    "--weight": "--mass",
    **dict.fromkeys(("--silent", "-q"), "--quiet"),
    "--fast": "--quick",
}


def run_command(argv: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code.

    Args:
        argv: the words after `holdfast`; None takes those of this process.
    """
    mend_streams()
    words = list(sys.argv[1:] if argv is None else argv)
    try:
        require_supported_platform()
        with warnings.catch_warnings():
            if not sys.warnoptions:
                # What libraries warn of is for developers; users are told in our own words.
                warnings.simplefilter("ignore")
            warnings.simplefilter("always", InputWarning)
            warnings.showwarning = _show_warning(warnings.showwarning)
            return _dispatch(words)
    except HoldfastError as error:
        return _complain(str(error))
    except MemoryError:
        return _complain("out of memory")
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _complain(f"{where}{error.strerror or error}")
    except KeyboardInterrupt:
        print("holdfast: interrupted", file=sys.stderr)
        return INTERRUPTED


def _complain(text: str) -> int:
    """Names from a user's file may hold anything; an error is one plain line all the same."""
    with suppress(OSError):  # nobody listens
        print("holdfast:", one_line(shortened(text, _LONGEST_ERROR)), file=sys.stderr)
    return BAD_INPUT


def _show_warning(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Shows warnings about input as a plain line each, once, and others as before."""
    shown: set[str] = set()

    def show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
        if not issubclass(category, InputWarning):
            otherwise(message, category, *where, **more)
        elif str(message) not in shown:
            shown.add(str(message))
            print("holdfast: warning:", printable(str(message)), file=sys.stderr)

    return show


def _unknown(word: str, parser: argparse.ArgumentParser, command: Command | None, rest: Sequence[str]) -> str:
    """What is said of a word that no command takes there, among those after the command."""
    if command is not None and (meant := _two_words(command.name, rest)):
        return meant
    source = "" if command is None else f"{command.name}: "
    if not word.startswith("-"):
        return f"{source}unknown argument {word!r}"
    options = long_options(parser)
    meant = nearest_name(word, options)
    if meant is None and (ours := _ELSEWHERE.get(word)) in options:
        meant = ours
    hint = f"did you mean {meant!r}?" if meant else f"`{parser.prog} --help` lists the options"
    return f"{source}unknown option {shortened(word, _LONGEST_WORD)!r}; {hint}"


def _two_words(first: str, rest: Sequence[str]) -> str | None:
    """What is said where a command of two words has its second one misspelt; None where that is not so."""
    seconds = [name.removeprefix(f"{first} ") for name in COMMANDS if name.startswith(f"{first} ")]
    meant = nearest_name(rest[0], seconds) if seconds and rest else None
    return None if meant is None else f"unknown command '{first} {rest[0]}'; did you mean '{first} {meant}'?"


def _dispatch(words: list[str]) -> int:
    if not words:
        top_parser().print_help()
        return 0
    command, rest = find_command(words)
    if command is None and not words[0].startswith("-"):
        if meant := _two_words(words[0], words[1:]):
            raise UsageError(meant)
        known = [*COMMANDS, *long_options(top_parser())]
        raise UsageError(f"unknown command {words[0]!r}{suggest(words[0], known)}")
    parser = top_parser() if command is None else command_parser(command)
    try:
        arguments, unknown = parser.parse_known_args(rest)
    except SystemExit as finished:  # --help and --version
        return int(finished.code or 0)
    if unknown:
        raise UsageError(_unknown(unknown[0], parser, command, rest))
    if command is None:
        raise UsageError(f"a command is missing{suggest('', COMMANDS)}")
    console = Console(quiet=getattr(arguments, "quiet", False))
    when_compiling(
        lambda: console.say("compiling the inner loops, once after an installation: about a minute")
    )
    try:
        with interrupting(), in_place(arguments):
            if command.draws:
                expect_choice()
            return command.runs.main(arguments)
    except InputError as error:
        # Late: it reads files, which takes libraries that a good command line may do without.
        from .wrong_kind import wrong_kind

        better = wrong_kind(parser, arguments, error)
        if better is None:
            raise
        raise UsageError(better) from error
    finally:
        when_compiling(None)
