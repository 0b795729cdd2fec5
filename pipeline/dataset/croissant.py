"""Croissant: a description of the data set for programs."""

from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Any

from ..tables import About, Table
from ..tables import croissant as described

__all__ = ["croissant"]

# Columns of other tables that a column names. That of outcomes on candidates is left unsaid, for readers
# follow it on to the objects, and the reader of Croissant's makers (1.1) breaks down over two in a row.
_REFERENCES = {("candidates", "object_id"): "objects/object_id"}


def croissant(
    folder: Path, files: Sequence[str], tables: Sequence[Table], head: dict[str, Any], published: date
) -> dict[str, Any]:
    """The description.

    Args:
        folder: of the data set.
        files: names of its files.
        tables: what its Parquet files hold.
        head: what `dataset.json` says.
        published: when it was written.
    """
    counts = head["counts"]
    about = About(
        name=f"holdfast-choice-{counts['objects']}-objects-seed-{head['seed']}",
        description=(
            f"{counts['candidates']} certified grasps in {counts['groups']} situations of choice, tried in "
            "simulation under hidden mass, friction, centre of mass and placement: "
            f"{counts['outcomes']} outcomes."
        ),
        version=head["schema_version"],
        licence=head["licence"],
        url="dataset.json",
        published=published,
    )
    return described(folder, files, tables, about, references=_REFERENCES)
