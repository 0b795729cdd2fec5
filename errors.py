"""The errors Holdfast raises for misuse; a mathematical outcome, such as infeasible, is a value instead."""

import difflib
from collections.abc import Iterable
from pathlib import Path

__all__ = ["HoldfastError", "InputError", "MissingBackend", "UnknownName", "suggest"]


class HoldfastError(Exception):
    """Base of every error that Holdfast raises on purpose."""


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
        where = f"{self.source}: {field}" if field else self.source
        super().__init__(f"{where}: {allowed}")


class UnknownName(InputError):
    """A name that is not among the known ones.

    Attributes:
        name: the name asked for.
        known: the names that exist.
    """

    def __init__(self, source: str | Path, field: str, kind: str, name: str, known: Iterable[str]):
        self.name = name
        self.known = tuple(known)
        super().__init__(source, field, f"unknown {kind} {name!r}{suggest(name, self.known)}")


class MissingBackend(HoldfastError):
    """A part of the machine that a request needs (such as an OpenGL backend) is missing."""


def suggest(name: str, known: Iterable[str]) -> str:
    """Returns `; did you mean ...?` or the list of known names, for the end of a message."""
    names = list(known)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    if close:
        return f"; did you mean {close[0]!r}?"
    return f"; known: {', '.join(names)}" if names else "; none is known"
