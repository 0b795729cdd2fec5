"""The libraries of the extra `data`, imported where they are needed."""

from typing import Any

from ...base.machine.extras import from_extra
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
    return from_extra(module, "data", what)


def has_parquet() -> bool:
    """Whether Parquet tables can be written."""
    try:
        need("pyarrow.parquet", "")
    except MissingBackend:
        return False
    return True
