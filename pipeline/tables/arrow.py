"""The Arrow types of columns."""

from collections.abc import Sequence
from typing import Any

from .column import Column, Kind

__all__ = ["arrow_schema"]


def arrow_schema(arrow: Any, columns: Sequence[Column], *, says: str, nullable: bool) -> Any:
    """Columns as Arrow has them.

    Args:
        arrow: the package pyarrow.
        columns: the columns.
        says: the key under which each field's metadata has its meaning.
        nullable: whether values may be missing.
    """
    return arrow.schema(
        [
            arrow.field(
                column.name, _type(arrow, column.kind), nullable=nullable, metadata={says: column.says}
            )
            for column in columns
        ]
    )


def _type(arrow: Any, kind: Kind) -> Any:
    text, number, numbers = arrow.string(), arrow.float64(), arrow.list_(arrow.float64())
    contact = {
        "hand": text,
        "object": text,
        "point_m": numbers,
        "normal": numbers,
        "gap_m": number,
        "region_gap_m": number,
        "normal_angle_rad": number,
        "opposed_within_deg": number,
    }
    direction = {
        "gravity_m_s2": numbers,
        "held": arrow.bool_(),
        "outcome": text,
        "slip_m": number,
        "turn_rad": number,
    }
    return {
        "text": text,
        "texts": arrow.list_(text),
        "whole": arrow.int64(),
        "small whole": arrow.int32(),
        "number": number,
        "small number": arrow.float32(),
        "numbers": numbers,
        "truth": arrow.bool_(),
        "numbers by name": arrow.map_(text, number),
        "texts by name": arrow.map_(text, text),
        "contacts": arrow.list_(arrow.struct(list(contact.items()))),
        "directions": arrow.list_(arrow.struct(list(direction.items()))),
    }[kind]
