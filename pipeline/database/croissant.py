"""Metadata of a table of grasps in the Croissant format, by which data sets are found and loaded."""

from datetime import date
from pathlib import Path
from typing import Any

from ..tables import About, Table
from ..tables import croissant as described
from .columns import COLUMNS, SCHEMA_VERSION

__all__ = ["croissant"]


def croissant(
    table: Path, *, name: str, rows: int, published: date, licence: str | None = None
) -> dict[str, Any]:
    """What describes a Parquet table.

    Args:
        table: the file, which is to lie beside the metadata.
        name: of the data set.
        rows: how many grasps it holds.
        published: when it was written.
        licence: name or address of the licence that the data are given under; None says nothing of it.
    """
    about = About(
        name=name,
        description=f"{rows} grasps, each with its certificate, clearance and physical test, made by "
        f"Holdfast; schema version {SCHEMA_VERSION}. SI units; quaternions are w, x, y, z; poses are in the "
        "palm frame.",
        version=SCHEMA_VERSION,
        licence=licence,
        url=table.name,
        published=published,
    )
    return described(table.parent, [table.name], [Table("grasps", table.name, ("row",), COLUMNS)], about)
