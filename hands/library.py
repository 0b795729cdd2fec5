"""Built-in hands, and hands by path."""

from functools import cache
from importlib.resources import files
from pathlib import Path

from ..errors import UnknownName
from .hand import Hand
from .hand_file import read_hand

__all__ = ["builtin_hands", "load_hand"]


def _folder() -> Path:
    return Path(str(files(__package__))) / "data"


def builtin_hands() -> tuple[str, ...]:
    """Names of the built-in hands, sorted."""
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


@cache
def _builtin(name: str) -> Hand:
    return read_hand(_folder() / f"{name}.yaml")


def load_hand(name_or_path: str | Path, *, source: str = "hand", field: str = "") -> Hand:
    """Loads a built-in hand by name, or a hand file by path.

    Args:
        name_or_path: a name from `builtin_hands()`, or a path that ends in .yaml or .yml.
        source: what asked for the hand, for the error message.
        field: field of `source` that names the hand.

    Raises:
        InputError: no such hand, or a file that can't be used.
    """
    text = str(name_or_path)
    if text.endswith((".yaml", ".yml")):
        return read_hand(Path(text))
    if text not in builtin_hands():
        raise UnknownName(source, field, "hand", text, builtin_hands())
    return _builtin(text)
