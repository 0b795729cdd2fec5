"""What is built in as files of a package, and the same things by path."""

from collections.abc import Callable
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Generic, TypeVar

from ...arguments import check_name_or_path
from ...errors import UnknownName

__all__ = ["FILE_SUFFIXES", "Library"]

FILE_SUFFIXES = (".yaml", ".yml")
"""What a path ends in, and a built-in name does not."""

T = TypeVar("T")


class Library(Generic[T]):
    """The files of one kind in the folder `data` of a package.

    Args:
        package: the package.
        kind: what one of them is called in messages.
        read: reads one from its file; a built-in one is read once.
        otherwise: what may stand in the place of a built-in name, for messages.
        suffixes: what the path of such a file ends in.
    """

    def __init__(
        self,
        package: str,
        kind: str,
        read: Callable[[Path], T],
        otherwise: str,
        suffixes: tuple[str, ...] = FILE_SUFFIXES,
    ):
        self._folder = Path(str(files(package))) / "data"
        self._kind = kind
        self._read = read
        self._otherwise = otherwise
        self._suffixes = suffixes
        self._builtin: Callable[[str], T] = cache(lambda name: read(self._folder / f"{name}.yaml"))

    def names(self) -> tuple[str, ...]:
        """Built-in names, sorted."""
        return tuple(sorted(path.stem for path in self._folder.glob("*.yaml")))

    def load(self, name_or_path: str | Path, source: str, field: str) -> T:
        """Loads by name or path; `source` and `field` say what asked for it, for the error message.

        Raises:
            InputError: no such name, or a file that can't be used.
        """
        allowed = f"must be the name of a built-in {self._kind}, or {self._otherwise}"
        text = check_name_or_path(name_or_path, source, field, allowed)
        path = self.path(text, source, field)
        return self._read(path) if text.lower().endswith(self._suffixes) else self._builtin(text)

    def path(self, name_or_path: str, source: str, field: str) -> Path:
        """The file of what is built in by that name, or the path itself.

        Raises:
            UnknownName: neither.
        """
        if name_or_path.lower().endswith(self._suffixes):
            return Path(name_or_path)
        if name_or_path not in self.names():
            raise UnknownName(
                source, field, self._kind, name_or_path, self.names(), otherwise=self._otherwise
            )
        return self._folder / f"{name_or_path}.yaml"
