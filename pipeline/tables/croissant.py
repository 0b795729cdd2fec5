"""Metadata in the Croissant format 1.0 (JSON-LD), by which data sets are found and loaded.

What it is: https://docs.mlcommons.org/croissant
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from ... import __version__
from .column import Column, Kind, Table

__all__ = ["About", "croissant"]

_VERSION = "http://mlcommons.org/croissant/1.0"
_CHUNK_BYTES = 1 << 20
# What is kept by name, or in parts, has no type there: such columns are left to the file's own schema.
_TYPES: dict[Kind, tuple[str, bool]] = {
    "text": ("sc:Text", False),
    "texts": ("sc:Text", True),
    "whole": ("sc:Integer", False),
    "small whole": ("sc:Integer", False),
    "number": ("sc:Float", False),
    "small number": ("sc:Float", False),
    "numbers": ("sc:Float", True),
    "truth": ("sc:Boolean", False),
}
_FORMATS = {
    ".parquet": "application/x-parquet",
    ".json": "application/json",
    ".npz": "application/zip",
    ".zip": "application/zip",
}
_LICENCES = {
    "Apache-2.0": "https://spdx.org/licenses/Apache-2.0.html",
    "CC-BY-4.0": "https://spdx.org/licenses/CC-BY-4.0.html",
    "CC0-1.0": "https://spdx.org/licenses/CC0-1.0.html",
}
# Names of the vocabulary that stand for others; the rest is schema.org's.
_OF_CROISSANT = [
    "citeAs",
    "column",
    "equivalentProperty",
    "extract",
    "field",
    "fileObject",
    "fileProperty",
    "fileSet",
    "format",
    "includes",
    "isLiveDataset",
    "jsonPath",
    "key",
    "md5",
    "parentField",
    "path",
    "recordSet",
    "references",
    "regex",
    "repeated",
    "replace",
    "samplingRate",
    "separator",
    "source",
    "subField",
    "transform",
]


@dataclass(frozen=True)
class About:
    """What is said of a data set as a whole.

    Attributes:
        name: of it.
        description: what it holds, for people.
        version: of its layout.
        licence: name or address of the licence that the data are given under; None says nothing of it.
        url: where it is, relative to the metadata.
        published: when it was written.
    """

    name: str
    description: str
    version: int
    licence: str | None
    url: str
    published: date


def croissant(
    folder: Path,
    files: Sequence[str],
    tables: Sequence[Table],
    about: About,
    *,
    references: Mapping[tuple[str, str], str] | None = None,
) -> dict[str, Any]:
    """The description of a data set.

    Args:
        folder: where its files lie, beside which the metadata are to lie.
        files: their names, those of the tables among them.
        tables: what its Parquet files hold.
        about: the whole.
        references: columns of other tables, as `table/column`, that a column of a table names.
    """
    licence = {} if about.licence is None else {"license": _LICENCES.get(about.licence, about.licence)}
    return {
        "@context": _context(),
        "@type": "sc:Dataset",
        "name": about.name,
        "description": about.description,
        "conformsTo": _VERSION,
        **licence,
        "url": about.url,
        "version": f"{about.version}.0.0",
        "datePublished": about.published.isoformat(),
        "citeAs": "Holdfast, see CITATION.cff of the software",
        "creator": {"@type": "sc:Organization", "name": f"made with Holdfast {__version__}"},
        "distribution": [_file(folder / name) for name in files],
        "recordSet": [_records(table, references or {}) for table in tables],
    }


def _file(path: Path) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": path.name,
        "name": path.name,
        "contentUrl": path.name,
        "contentSize": f"{path.stat().st_size} B",
        "encodingFormat": _FORMATS[path.suffix],
        "sha256": _sha256(path),
    }


def _records(table: Table, references: Mapping[tuple[str, str], str]) -> dict[str, Any]:
    return {
        "@type": "cr:RecordSet",
        "@id": table.name,
        "name": table.name,
        "key": [{"@id": f"{table.name}/{name}"} for name in table.key],
        "field": [_field(table, column, references) for column in table.columns if column.kind in _TYPES],
    }


def _field(table: Table, column: Column, references: Mapping[tuple[str, str], str]) -> dict[str, Any]:
    kind, repeated = _TYPES[column.kind]
    field: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"{table.name}/{column.name}",
        "name": column.name,
        "description": column.says,
        "dataType": kind,
        "source": {"fileObject": {"@id": table.file}, "extract": {"column": column.name}},
    }
    named = references.get((table.name, column.name))
    more: dict[str, Any] = {"repeated": True} if repeated else {}
    return field | more | ({"references": {"field": {"@id": named}}} if named else {})


def _context() -> dict[str, Any]:
    return {
        "@language": "en",
        "@vocab": "https://schema.org/",
        "sc": "https://schema.org/",
        "cr": "http://mlcommons.org/croissant/",
        "rai": "http://mlcommons.org/croissant/RAI/",
        "dct": "http://purl.org/dc/terms/",
        "conformsTo": "dct:conformsTo",
        "data": {"@id": "cr:data", "@type": "@json"},
        "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
        "examples": {"@id": "cr:examples", "@type": "@json"},
        **{name: f"cr:{name}" for name in _OF_CROISSANT},
    }


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK_BYTES):
            digest.update(chunk)
    return digest.hexdigest()
