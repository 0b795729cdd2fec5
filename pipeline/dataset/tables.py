"""The data set as Parquet: objects, candidates, outcomes."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...base.files.output_file import write_bytes
from ..choice import CONDITIONS, ChoiceData
from ..tables import Column, Table, arrow_schema
from .part import Part

__all__ = ["write_tables"]


def write_tables(folder: Path, parts: Sequence[Part], data: ChoiceData) -> list[Table]:
    """Writes the tables, and says what they are.

    Args:
        folder: where to.
        parts: those of the groups of `data`, in their order.
        data: the arrays.
    """
    tables = []
    for table, rows in (_objects(parts, data), _candidates(parts, data), _outcomes(parts, data)):
        _write(folder / table.file, table, rows)
        tables.append(table)
    return tables


Rows = dict[str, list[Any]]


def _write(path: Path, table: Table, rows: Rows) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    schema = arrow_schema(pa, table.columns, says="description", nullable=False)
    content = pa.table([pa.array(rows[f.name], f.type) for f in schema], schema=schema)
    buffer = io.BytesIO()
    pq.write_table(content, buffer, compression="zstd")
    write_bytes(path, buffer.getvalue())


def _objects(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("object_id", "text", "name by which `load_object` makes it again"),
        Column("kind", "text", "family, builtin or file"),
        Column("family", "text", "its family, or its name"),
        Column("seed", "small whole", "seed in its family, else -1"),
        *(Column(f.name, "small number", _with_unit(f.words, f.unit)) for f in data.object_specs),
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
    return Table("objects", "objects.parquet", ("object_id",), columns), rows


def _kind(reference: str) -> str:
    if reference.startswith("family:"):
        return "family"
    return "file" if Path(reference).suffix else "builtin"


def _candidates(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("candidate_id", "text", "its name"),
        Column("group_id", "small whole", "situation: object, hand and contacts"),
        Column("object_id", "text", "its object"),
        Column("task_kind", "text", "kind of the object and number of contacts"),
        Column("test", "text", "what the hand must do: lift, turn or press"),
        Column("hand", "text", "name of the hand"),
        Column("hand_hash", "text", "hash of all that is said of the hand"),
        Column("joints", "numbers by name", "positions of all joints by name, in rad, of sliding ones in m"),
        *(
            Column(f"position_{axis}", "number", f"{axis} of the object in the palm frame, in m")
            for axis in "xyz"
        ),
        *(
            Column(f"quaternion_{axis}", "number", f"{axis} of its orientation in the palm frame")
            for axis in "wxyz"
        ),
        Column("seed", "small whole", "seed of the data set"),
        *(Column(f"split_{name}", "text", f"part of the split by {name}") for name in data.splits),
        *(Column(f.name, "small number", _with_unit(f.words, f.unit)) for f in data.feature_specs),
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
    return Table("candidates", "candidates.parquet", ("candidate_id",), columns), rows


def _outcomes(parts: Sequence[Part], data: ChoiceData) -> tuple[Table, Rows]:
    columns = (
        Column("candidate_id", "text", "of the candidate"),
        Column("draw", "small whole", "which draw of its group"),
        Column("load", "number", "multiple of the load"),
        *(Column(name, "small number", _with_unit(words, unit)) for name, unit, words in CONDITIONS),
        Column("held", "truth", "whether the hand held the object"),
        Column(
            "margin",
            "small number",
            "share of the limits of slip and turn that was left; at most 0 where not held",
        ),
        Column("outcome", "text", "how it ended, in words"),
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
    return Table("outcomes", "outcomes.parquet", ("candidate_id", "draw", "load"), columns), rows


def _with_unit(words: str, unit: str) -> str:
    return words if unit == "1" else f"{words}, in {unit}"
