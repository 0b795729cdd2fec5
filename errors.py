"""The errors Holdfast raises for misuse; a mathematical outcome, such as infeasible, is a value instead."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .base.text.plain_text import one_line, shortened
from .base.text.spelling import nearest_name

__all__ = ["HoldfastError", "InputError", "InputWarning", "MissingBackend", "UnknownName", "suggest"]


_LONGEST_NAME = 64
_MOST_NAMES = 20
# Of a message: enough for what we say, and short enough to be read where a value of the user's is long.
_LONGEST_SOURCE, _LONGEST_FIELD, _LONGEST_WORDS = 300, 160, 1000


class HoldfastError(Exception):
    """Base of every error that Holdfast raises on purpose."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Lets it come back from another process: made of its facts, not by a call with its message."""
        return _as_it_was, (type(self), self.args, self.__dict__)


class InputError(HoldfastError):
    """A file or argument that can't be used: names the source, the field and what is allowed.

    Attributes:
        source: the file or argument at fault.
        field: dotted path of the field inside it, empty for the whole.
        allowed: what would be accepted, or what is wrong.
    """

    def __init__(self, source: str | Path, field: str, allowed: str):
        self.source = str(source)
        self.field = field
        self.allowed = allowed
        shown = shortened(self.source, _LONGEST_SOURCE)
        where = f"{shown}: {shortened(field, _LONGEST_FIELD)}" if field else shown
        super().__init__(one_line(f"{where}: {shortened(allowed, _LONGEST_WORDS)}"))


class UnknownName(InputError):
    """A name that is not among the known ones.

    Args:
        source: the file or argument at fault.
        field: dotted path of the field inside it, empty for the whole.
        kind: what it should be the name of.
        name: the name asked for.
        known: the names that exist.
        otherwise: what may stand in the place of a name.

    Attributes:
        name: the name asked for.
        known: the names that exist.
    """

    def __init__(
        self,
        source: str | Path,
        field: str,
        kind: str,
        name: str,
        known: Iterable[str],
        *,
        otherwise: str = "",
    ):
        self.name = name
        self.known = tuple(known)
        shown = name if len(name) <= _LONGEST_NAME else name[:_LONGEST_NAME] + "..."
        words = suggest(name, self.known)
        # A slip of the pen needs no other ways.
        if otherwise and nearest_name(name, self.known) is None:
            words += f"; or {otherwise}"
        super().__init__(source, field, f"unknown {kind} {shown!r}{words}")


class InputWarning(UserWarning):
    """Something in a file or an argument that can be used and is probably a slip; one line.

    Args:
        source: the file or argument.
        field: dotted path of the field inside it, empty for the whole.
        text: what is odd, and what was probably meant.
    """

    def __init__(self, source: str | Path, field: str, text: str):
        super().__init__(one_line(f"{source}: {field}: {text}" if field else f"{source}: {text}"))


class MissingBackend(HoldfastError):
    """A part of the machine that a request needs (such as an OpenGL backend) is missing."""


def suggest(name: str, known: Iterable[str]) -> str:
    """Returns `; did you mean ...?` or the known names, for the end of a message."""
    names = list(known)
    close = nearest_name(name, names)
    if close is not None:
        return f"; did you mean {close!r}?"
    if not names:
        return "; none is known"
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return f"; known: {', '.join(names[:_MOST_NAMES])}{more}"


def _as_it_was(kind: type[HoldfastError], args: tuple[Any, ...], facts: dict[str, Any]) -> HoldfastError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(facts)
    return error
