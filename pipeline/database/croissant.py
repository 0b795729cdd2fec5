"""Metadata of a table in the Croissant format 1.0 (JSON-LD), by which data sets are found and loaded."""

import hashlib
from pathlib import Path
from typing import Any

from .columns import COLUMNS, SCHEMA_VERSION, Kind

__all__ = ["croissant"]

_VERSION = "http://mlcommons.org/croissant/1.0"
_CHUNK_BYTES = 1 << 20
# What is kept by name, or in parts, has no type there: such columns are left to the file's own schema.
_TYPES: dict[Kind, tuple[str, bool]] = {
    "text": ("sc:Text", False),
    "texts": ("sc:Text", True),
    "whole": ("sc:Integer", False),
    "number": ("sc:Float", False),
    "numbers": ("sc:Float", True),
    "truth": ("sc:Boolean", False),
}
# Names of the vocabulary that stand for others; the rest is schema.org's.
_OF_CROISSANT = [
    "citeAs",
    "column",
    "equivalentProperty",
    "extract",
    "field",
    "fileProperty",
    "fileObject",
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


def croissant(table: Path, *, name: str, rows: int, licence: str | None = None) -> dict[str, Any]:
    """What describes a Parquet table.

    Args:
        table: the file, which is to lie beside the metadata.
        name: of the data set.
        rows: how many grasps it holds.
        licence: name or address of the licence that the data are given under; None says nothing of it.
    """
    about = {
        "@context": _context(),
        "@type": "sc:Dataset",
        "conformsTo": _VERSION,
        "name": name,
        "description": f"{rows} grasps, each with its certificate, clearance and physical test, made by "
        f"Holdfast; schema version {SCHEMA_VERSION}. SI units; quaternions are w, x, y, z; poses are in the "
        "palm frame.",
        "url": table.name,
        "version": f"{SCHEMA_VERSION}.0.0",
    }
    if licence is not None:
        about["license"] = licence
    return about | {"distribution": [_file(table)], "recordSet": [_records(table)]}


def _file(table: Path) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": table.name,
        "name": table.name,
        "contentUrl": table.name,
        "encodingFormat": "application/x-parquet",
        "contentSize": f"{table.stat().st_size} B",
        "sha256": _sha256(table),
    }


def _records(table: Path) -> dict[str, Any]:
    fields = []
    for column in COLUMNS:
        if column.kind in _TYPES:
            kind, repeated = _TYPES[column.kind]
            source = {"fileObject": {"@id": table.name}, "extract": {"column": column.name}}
            entry = {
                "@type": "cr:Field",
                "@id": f"grasps/{column.name}",
                "name": column.name,
                "description": column.says,
                "dataType": kind,
                "source": source,
            }
            fields.append(entry | ({"repeated": True} if repeated else {}))
    return {
        "@type": "cr:RecordSet",
        "@id": "grasps",
        "name": "grasps",
        "key": {"@id": "grasps/row"},
        "field": fields,
    }


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
