"""The libraries of the extra `data`, imported where they are needed."""

from importlib import import_module
from typing import Any

from ...errors import MissingBackend

__all__ = ["has_parquet", "need"]


def need(module: str, what: str) -> Any:
    """A module of the extra.

    Args:
        module: its name.
        what: needs it, such as `a Parquet table`.

    Raises:
        MissingBackend: it is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError:
        package = module.partition(".")[0]
        raise MissingBackend(f"{what} needs {package}: pip install 'holdfast[data]'") from None


def has_parquet() -> bool:
    """Whether Parquet tables can be written."""
    try:
        need("pyarrow.parquet", "")
    except MissingBackend:
        return False
    return True
