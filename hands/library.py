"""Built-in hands, and hands by path."""

from pathlib import Path

from ..base.files.file_suffixes import MODEL_SUFFIXES
from ..base.files.library import FILE_SUFFIXES, Library
from .hand import Hand
from .reader import read_hand

__all__ = ["HAND_SUFFIXES", "builtin_hands", "hand_file", "load_hand"]

HAND_SUFFIXES = (*FILE_SUFFIXES, *MODEL_SUFFIXES)
"""What the path of a hand ends in: that of a hand file, or of a model in MJCF or URDF."""

_PATHS = "the path of a hand file (.yaml) or of a model (.xml, .mjcf, .urdf)"
_LIBRARY = Library(__package__, "hand", read_hand, _PATHS, HAND_SUFFIXES)


def builtin_hands() -> tuple[str, ...]:
    """Names of the built-in hands, sorted."""
    return _LIBRARY.names()


def load_hand(name_or_path: str | Path, *, source: str = "hand", field: str = "") -> Hand:
    """Loads a built-in hand by name, or a hand file or a model by path.

    Args:
        name_or_path: a name from `builtin_hands()`, or a path that ends in one of `HAND_SUFFIXES`.
        source: what asked for the hand, for the error message.
        field: field of `source` that names the hand.

    Raises:
        InputError: no such hand, or a file that can't be used.
    """
    return _LIBRARY.load(name_or_path, source, field)


def hand_file(name_or_path: str) -> Path:
    """The file of a built-in hand, or the path itself.

    Raises:
        UnknownName: neither.
    """
    return _LIBRARY.path(name_or_path, "hand", "")
