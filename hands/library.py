"""Built-in hands, and hands by path."""

from pathlib import Path

from ..library import Library
from .hand import Hand
from .reader import read_hand

__all__ = ["builtin_hands", "load_hand"]

_LIBRARY = Library(__package__, "hand", read_hand)


def builtin_hands() -> tuple[str, ...]:
    """Names of the built-in hands, sorted."""
    return _LIBRARY.names()


def load_hand(name_or_path: str | Path, *, source: str = "hand", field: str = "") -> Hand:
    """Loads a built-in hand by name, or a hand file by path.

    Args:
        name_or_path: a name from `builtin_hands()`, or a path that ends in .yaml or .yml.
        source: what asked for the hand, for the error message.
        field: field of `source` that names the hand.

    Raises:
        InputError: no such hand, or a file that can't be used.
    """
    return _LIBRARY.load(name_or_path, source, field)
