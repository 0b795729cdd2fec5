"""Croissant: a description of the data set for programs (JSON-LD, https://docs.mlcommons.org/croissant)."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .tables import Column, Table

__all__ = ["croissant"]

_CONTEXT: dict[str, Any] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "citeAs": "cr:citeAs",
    "column": "cr:column",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "equivalentProperty": "cr:equivalentProperty",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "extract": "cr:extract",
    "field": "cr:field",
    "fileObject": "cr:fileObject",
    "fileProperty": "cr:fileProperty",
    "fileSet": "cr:fileSet",
    "format": "cr:format",
    "includes": "cr:includes",
    "isLiveDataset": "cr:isLiveDataset",
    "jsonPath": "cr:jsonPath",
    "key": "cr:key",
    "md5": "cr:md5",
    "parentField": "cr:parentField",
    "path": "cr:path",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "recordSet": "cr:recordSet",
    "references": "cr:references",
    "regex": "cr:regex",
    "repeated": "cr:repeated",
    "replace": "cr:replace",
    "samplingRate": "cr:samplingRate",
    "sc": "https://schema.org/",
    "separator": "cr:separator",
    "source": "cr:source",
    "subField": "cr:subField",
    "transform": "cr:transform",
}
_TYPES = {
    "string": "sc:Text",
    "bool": "sc:Boolean",
    "int32": "sc:Integer",
    "float32": "sc:Float",
    "float64": "sc:Float",
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
# Columns of other tables that a column names. That of outcomes on candidates is left unsaid, for readers
# follow it on to the objects, and the reader of Croissant's makers (1.1) breaks down over two in a row.
_REFERENCES = {("candidates", "object_id"): "objects/object_id"}


def croissant(
    folder: Path, files: Sequence[str], tables: Sequence[Table], head: dict[str, Any], *, date: str
) -> dict[str, Any]:
    """The description.

    Args:
        folder: of the data set.
        files: names of its files.
        tables: what its Parquet files hold.
        head: what `dataset.json` says.
        date: of the data, as ISO 8601 has it.
    """
    counts = head["counts"]
    return {
        "@context": _CONTEXT,
        "@type": "sc:Dataset",
        "name": f"holdfast-choice-{counts['objects']}-objects-seed-{head['seed']}",
        "description": (
            f"{counts['candidates']} certified grasps in {counts['groups']} situations of choice, tried in "
            "simulation under hidden mass, friction, centre of mass and placement: "
            f"{counts['outcomes']} outcomes."
        ),
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "license": _LICENCES.get(head["licence"], head["licence"]),
        "version": f"{head['schema_version']}.0.0",
        "datePublished": date,
        "citeAs": "Holdfast, see CITATION.cff of the software",
        "creator": {"@type": "sc:Organization", "name": "made with Holdfast"},
        "distribution": [_file(folder / name) for name in files],
        "recordSet": [_records(table) for table in tables],
    }


def _file(path: Path) -> dict[str, Any]:
    content = path.read_bytes()
    return {
        "@type": "cr:FileObject",
        "@id": path.name,
        "name": path.name,
        "contentUrl": path.name,
        "contentSize": f"{len(content)} B",
        "encodingFormat": _FORMATS[path.suffix],
        "sha256": hashlib.sha256(content).hexdigest(),
    }


def _records(table: Table) -> dict[str, Any]:
    return {
        "@type": "cr:RecordSet",
        "@id": table.name,
        "name": table.name,
        "key": [{"@id": f"{table.name}/{name}"} for name in table.key],
        # Croissant has no word for a map, such as that of the joints: it stands in the Parquet file alone.
        "field": [_field(table, column) for column in table.columns if column.type in _TYPES],
    }


def _field(table: Table, column: Column) -> dict[str, Any]:
    field: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"{table.name}/{column.name}",
        "name": column.name,
        "description": column.words,
        "dataType": _TYPES[column.type],
        "source": {"fileObject": {"@id": f"{table.name}.parquet"}, "extract": {"column": column.name}},
    }
    reference = _REFERENCES.get((table.name, column.name))
    return field | ({"references": {"field": {"@id": reference}}} if reference else {})
