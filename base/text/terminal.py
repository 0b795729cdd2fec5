"""Whether words go to a terminal, how wide that is, and colours for what they say there."""

import os
import re
import shutil
from typing import TextIO

__all__ = ["has_colours", "painted", "terminal_width"]

_BOLD, _DIM, _RED, _GREEN, _YELLOW = 1, 2, 31, 32, 33
_RULE = re.compile(r"-+(?:  +-+)*")
# The verdict with which a result begins: `upholding: held; ...`, or `accepted: ...`.
_VERDICT = re.compile(
    r"^((?:[^\s:]+: )?)"
    r"(?:(held|passed|turned|pressed|solved|complete|accepted)"
    r"|(not \w+|infeasible|rejected)|(undecided|not tested))\b(?=[:;, ]|$)"
)
_COLOUR_OF_VERDICT = {2: _GREEN, 3: _RED, 4: _YELLOW}


def has_colours(stream: TextIO) -> bool:
    """Whether a stream takes colours: a terminal does, unless the variable NO_COLOR or TERM=dumb says no."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def terminal_width(stream: TextIO) -> int | None:
    """Columns of the terminal that a stream leads to; None where it leads to none."""
    return shutil.get_terminal_size().columns if stream.isatty() else None


def painted(text: str) -> str:
    """Text for a terminal: heads of tables in bold, their rules dim, verdicts in green, red or yellow."""
    lines = text.split("\n")
    out = []
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if _RULE.fullmatch(line):
            out.append(_in(_DIM, line))
        elif line.strip() and _RULE.fullmatch(below):
            out.append(_in(_BOLD, line))
        else:
            out.append(_VERDICT.sub(_painted_verdict, line))
    return "\n".join(out)


def _painted_verdict(found: re.Match[str]) -> str:
    which = next(group for group in _COLOUR_OF_VERDICT if found[group])
    return found[1] + _in(_COLOUR_OF_VERDICT[which], found[which])


def _in(colour: int, text: str) -> str:
    return f"\x1b[{colour}m{text}\x1b[0m"
