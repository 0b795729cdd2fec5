"""Columns and tables: names, kinds and meanings."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

__all__ = ["Column", "Kind", "Table"]

Kind: TypeAlias = Literal[
    "text", "texts", "whole", "small whole", "number", "small number", "numbers", "truth",
    "numbers by name", "texts by name", "contacts", "directions",
]  # fmt: skip
"""What values are: numbers have 64 bits, small ones 32."""


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        name: of the column.
        kind: what its values are.
        says: its meaning, with the unit where the name has none.
    """

    name: str
    kind: Kind
    says: str


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        name: of it.
        file: name of its Parquet file.
        key: the column, or columns, by which a row is known.
        columns: in order.
    """

    name: str
    file: str
    key: tuple[str, ...]
    columns: tuple[Column, ...]
