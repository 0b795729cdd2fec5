"""The data set as Parquet: objects, candidates, outcomes."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...files import write_bytes
from ..choice import CONDITIONS, ChoiceData
from .part import Part

__all__ = ["Column", "Table", "write_tables"]


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes:
        name: of the column.
        type: Arrow's name of its type.
        words: what it is, with its unit.
    """

    name: str
    type: str
    words: str


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        name: of its file, without the suffix.
        key: the column, or columns, by which a row is known.
        columns: in order.
    """

    name: str
    key: tuple[str, ...]
    columns: tuple[Column, ...]


def write_tables(folder: Path, parts: Sequence[Part], data: ChoiceData) -> list[Table]:
    """Writes the tables as `NAME.parquet`, and says what they are.

    Args:
        folder: where to.
        parts: those of the groups of `data`, in their order.
        data: the arrays.
    """
    tables = []
    for table, rows in (_objects(parts, data), _candidates(parts, data), _outcomes(parts, data)):
        _write(folder / f"{table.name}.parquet", table, rows)
        tables.append(table)
    return tables


Rows = dict[str, list[Any]]


def _write(path: Path, table: Table, rows: Rows) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    types = {
        "string": pa.string(),
        "bool": pa.bool_(),
        "int32": pa.int32(),
        "float32": pa.float32(),
        "float64": pa.float64(),
        "map<string, float64>": pa.map_(pa.string(), pa.float64()),
    }
    fields = [
        pa.field(column.name, types[column.type], nullable=False, metadata={"description": column.words})
        for column in table.columns
    ]
    content = pa.table([pa.array(rows[f.name], f.type) for f in fields], schema=pa.schema(fields))
    buffer = io.BytesIO()
    pq.write_table(content, buffer, compression="zstd")
    write_bytes(path, buffer.getvalue())


def _objects(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("object_id", "string", "name by which `load_object` makes it again"),
        Column("kind", "string", "family, builtin or file"),
        Column("family", "string", "its family, or its name"),
        Column("seed", "int32", "seed in its family, else -1"),
        *(Column(f.name, "float32", _with_unit(f.words, f.unit)) for f in data.object_specs),
    )
    ids = data.object_ids.tolist()
    first = {name: next(part for part in parts if part.plan[0] == name) for name in ids}
    rows: Rows = {
        "object_id": ids,
        "kind": [_kind(name) for name in ids],
        "family": [told.family if (told := first[name].told) else "" for name in ids],
        "seed": [int(name.rpartition(":")[2]) if name.startswith("family:") else -1 for name in ids],
    }
    rows |= {f.name: data.object_features[:, k].tolist() for k, f in enumerate(data.object_specs)}
    return Table("objects", ("object_id",), columns), rows


def _kind(reference: str) -> str:
    if reference.startswith("family:"):
        return "family"
    return "file" if Path(reference).suffix else "builtin"


def _candidates(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("candidate_id", "string", "its name"),
        Column("group_id", "int32", "situation: object, hand and contacts"),
        Column("object_id", "string", "its object"),
        Column("task_kind", "string", "kind of the object and number of contacts"),
        Column("test", "string", "what the hand must do: lift, turn or press"),
        Column("hand", "string", "name of the hand"),
        Column("hand_hash", "string", "hash of all that is said of the hand"),
        Column(
            "joints", "map<string, float64>", "positions of all joints by name, in rad, of sliding ones in m"
        ),
        *(
            Column(f"position_{axis}", "float64", f"{axis} of the object in the palm frame, in m")
            for axis in "xyz"
        ),
        *(
            Column(f"quaternion_{axis}", "float64", f"{axis} of its orientation in the palm frame")
            for axis in "wxyz"
        ),
        Column("seed", "int32", "seed of the data set"),
        *(Column(f"split_{name}", "string", f"part of the split by {name}") for name in data.splits),
        *(Column(f.name, "float32", _with_unit(f.words, f.unit)) for f in data.feature_specs),
    )
    solutions = [candidate.solution for part in parts for candidate in part.candidates]
    told = [part.told for part in parts for _ in part.candidates]
    rows: Rows = {
        "candidate_id": data.candidate_ids.tolist(),
        "group_id": data.group.tolist(),
        "object_id": data.object_ids[data.object_index].tolist(),
        "task_kind": data.task.tolist(),
        "test": [entry.test if entry else "" for entry in told],
        "hand": data.hand.tolist(),
        "hand_hash": [entry.hand_hash if entry else "" for entry in told],
        "joints": [list(solution.joints.items()) for solution in solutions],
        "seed": [part.seed for part in parts for _ in part.candidates],
    }
    rows |= {f"position_{a}": [s.object.position[k] for s in solutions] for k, a in enumerate("xyz")}
    rows |= {f"quaternion_{a}": [s.object.quaternion[k] for s in solutions] for k, a in enumerate("wxyz")}
    rows |= {f"split_{name}": values.tolist() for name, values in data.splits.items()}
    rows |= {f.name: data.features[:, k].tolist() for k, f in enumerate(data.feature_specs)}
    return Table("candidates", ("candidate_id",), columns), rows


def _outcomes(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("candidate_id", "string", "of the candidate"),
        Column("draw", "int32", "which draw of its group"),
        Column("load", "float64", "multiple of the load"),
        *(Column(name, "float32", _with_unit(words, unit)) for name, unit, words in CONDITIONS),
        Column("held", "bool", "whether the hand held the object"),
        Column(
            "margin",
            "float32",
            "share of the limits of slip and turn that was left; at most 0 where not held",
        ),
        Column("outcome", "string", "how it ended, in words"),
    )
    rows: Rows = {column.name: [] for column in columns}
    ids = iter(data.candidate_ids.tolist())
    for part in parts:
        for row in part.outcomes:
            candidate = next(ids)
            for d, draw in enumerate(row):
                for load, one in zip(data.loads, draw, strict=True):
                    rows["candidate_id"].append(candidate)
                    rows["draw"].append(d)
                    rows["load"].append(load)
                    for (name, _, _), value in zip(CONDITIONS, part.conditions[d], strict=True):
                        rows[name].append(value)
                    rows["held"].append(one.held)
                    rows["margin"].append(one.margin)
                    rows["outcome"].append(one.outcome)
    return Table("outcomes", ("candidate_id", "draw", "load"), columns), rows


def _with_unit(words: str, unit: str) -> str:
    return words if unit == "1" else f"{words}, in {unit}"
