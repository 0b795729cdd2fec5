"""What tables of ours are made of: columns with their meanings and Arrow types, and their description."""

from .arrow import arrow_schema
from .column import Column, Kind, Table
from .croissant import About, croissant

__all__ = ["About", "Column", "Kind", "Table", "arrow_schema", "croissant"]
