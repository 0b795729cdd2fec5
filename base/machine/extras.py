"""Packages that need not be installed: the extras of pyproject.toml, imported where they are needed."""

from importlib import import_module
from typing import Any

from ...errors import MissingBackend

__all__ = ["from_extra"]


def from_extra(module: str, extra: str, what: str, *, package: str | None = None) -> Any:
    """A module of a package that an extra brings.

    Args:
        module: its name.
        extra: which of ours brings it.
        what: needs it, such as `a Parquet table`.
        package: its name in the package index, where that is not the module's first word.

    Raises:
        MissingBackend: it is not installed, or does not find a library of the system's.
    """
    try:
        return import_module(module)
    except (ImportError, OSError):
        name = package or module.partition(".")[0]
        raise MissingBackend(f"{what} needs the package {name}: pip install 'holdfast[{extra}]'") from None
