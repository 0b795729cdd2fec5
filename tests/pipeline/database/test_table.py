"""Tables give back what was written, and name what is not what was written."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from holdfast.errors import InputError
from holdfast.pipeline.database import (
    COLUMNS,
    Collected,
    Row,
    check_table_target,
    checked_rows,
    find_row,
    write_table,
)
from holdfast.pipeline.database import write as write_module
from holdfast.pipeline.records import read_run

MakeRun = Callable[..., Path]
PARQUET = pytest.param("t.parquet", id="parquet")
LINES = pytest.param("t.jsonl", id="jsonl")


def written(name: str, folder: Path, *runs: Path) -> Path:
    if name.endswith(".parquet"):
        pytest.importorskip("pyarrow")
    table = folder / name
    write_table(Collected(runs, table), table)
    return table


def rewritten(table: Path, change: Callable[[list[dict[str, Any]]], None]) -> None:
    """Writes a table again, as somebody does who changes it with another tool."""
    parquet, arrow = pytest.importorskip("pyarrow.parquet"), pytest.importorskip("pyarrow")
    whole = parquet.read_table(table)
    rows = whole.to_pylist()
    change(rows)
    parquet.write_table(arrow.Table.from_pylist(rows, schema=whole.schema), table)


@pytest.mark.parametrize("name", [PARQUET, LINES])
def test_every_grasp_comes_back_as_it_was(name: str, tmp_path: Path, make_run: MakeRun) -> None:
    runs = [make_run("a", 7, seed=1), make_run("b", 5, seed=2)]
    table = written(name, tmp_path, *runs)
    expected = [grasp for run in runs for grasp in read_run(run / "run.json").grasps]
    found = list(checked_rows(table))
    assert [row.number for row in found if isinstance(row, Row)] == list(range(12))
    for row, grasp in zip(found, expected, strict=True):
        assert isinstance(row, Row)
        if grasp.hold is not None:  # slip curves are for drawings
            curveless = [entry.model_copy(update={"curve": []}) for entry in grasp.hold.directions]
            grasp = grasp.model_copy(update={"hold": grasp.hold.model_copy(update={"directions": curveless})})
        assert row.grasp == grasp and row.head.task == "pinch <&> \u00e9"
    assert find_row(table, 9) == found[9]


def test_both_forms_say_the_same(tmp_path: Path, make_run: MakeRun) -> None:
    run = make_run()
    tables = [written(name, tmp_path, run) for name in ("t.parquet", "t.jsonl")]
    assert list(checked_rows(tables[0])) == list(checked_rows(tables[1]))
    parquet = pytest.importorskip("pyarrow.parquet")
    assert parquet.read_schema(tables[0]).names == [column.name for column in COLUMNS]


def test_groups_of_rows_bound_memory(
    tmp_path: Path, make_run: MakeRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    monkeypatch.setattr(write_module, "GROUP_ROWS", 3)
    table = written("t.parquet", tmp_path, make_run(count=8))
    file = parquet.ParquetFile(table)
    assert [file.metadata.row_group(k).num_rows for k in range(file.num_row_groups)] == [3, 3, 2]
    assert [row.number for row in checked_rows(table) if isinstance(row, Row)] == list(range(8))


@pytest.mark.parametrize(
    ("column", "value"),
    [("held", True), ("margin", 9.0), ("certified", None), ("task", "other"), ("joints", [("joint_0", 1.0)]),
     ("record", "{}"), ("record", "[[["), ("seal", "0" * 64), ("seed", 5)],
)  # fmt: skip
def test_a_changed_row_is_named_and_the_others_stay(
    column: str, value: object, tmp_path: Path, make_run: MakeRun
) -> None:
    table = written("t.parquet", tmp_path, make_run(count=6))

    def change(rows: list[dict[str, Any]]) -> None:
        assert rows[2][column] != value
        rows[2][column] = value

    rewritten(table, change)
    found = list(checked_rows(table))
    assert [isinstance(row, Row) for row in found] == [True, True, False, True, True, True]
    assert "row 2" in str(found[2]) and "damaged" in str(found[2])
    with pytest.raises(InputError, match="row 2"):
        find_row(table, 2)


def test_a_seal_made_anew_does_not_cover_a_lie(tmp_path: Path, make_run: MakeRun) -> None:
    """Whoever changes a figure and seals it again contradicts the record, which is in the same row."""
    from holdfast.pipeline.database.row import _seal

    table = written("t.jsonl", tmp_path, make_run(count=3))
    lines = [json.loads(line) for line in table.read_text("utf-8").splitlines()]
    lines[1]["margin"] = 7.0
    lines[1]["seal"] = _seal({name: value for name, value in lines[1].items() if name != "seal"})
    table.write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
    with pytest.raises(InputError, match="column margin contradicts its record"):
        find_row(table, 1)


def test_flipped_bytes_are_named(tmp_path: Path, make_run: MakeRun, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(write_module, "GROUP_ROWS", 4)
    parquet = pytest.importorskip("pyarrow.parquet")
    table = written("t.parquet", tmp_path, make_run(count=12))
    group = parquet.ParquetFile(table).metadata.row_group(1)
    (record,) = (
        group.column(k) for k in range(group.num_columns) if group.column(k).path_in_schema == "record"
    )
    data = bytearray(table.read_bytes())
    data[record.data_page_offset + record.total_compressed_size - 100] ^= 0xFF
    table.write_bytes(data)
    found = list(checked_rows(table))
    (words,) = (row for row in found if isinstance(row, str))
    assert f"{table}: rows 4 to 7 of the file: can't be read" in words
    assert [row.number for row in found if isinstance(row, Row)] == [0, 1, 2, 3, 8, 9, 10, 11]


@pytest.mark.parametrize("kept", [0, 3, 100, -1])
def test_a_cut_file_is_refused(kept: int, tmp_path: Path, make_run: MakeRun) -> None:
    table = written("t.parquet", tmp_path, make_run())
    table.write_bytes(table.read_bytes()[:kept])
    with pytest.raises(InputError, match="is no Parquet file, or damaged"):
        list(checked_rows(table))


def test_cut_lines_are_named(tmp_path: Path, make_run: MakeRun) -> None:
    table = written("t.jsonl", tmp_path, make_run(count=4))
    table.write_bytes(table.read_bytes()[:-40])
    found = list(checked_rows(table))
    assert [isinstance(row, Row) for row in found] == [True, True, True, False]
    assert "line 4" in str(found[3])


def test_other_parquet_files_and_versions_are_refused(tmp_path: Path, make_run: MakeRun) -> None:
    parquet, arrow = pytest.importorskip("pyarrow.parquet"), pytest.importorskip("pyarrow")
    path = tmp_path / "other.parquet"
    parquet.write_table(arrow.table({"x": [1]}), path)
    with pytest.raises(InputError, match="is no table of grasps"):
        find_row(path, 0)
    table = parquet.read_table(written("t.parquet", tmp_path, make_run()))
    parquet.write_table(table.replace_schema_metadata({"holdfast_schema": "99"}), path)
    with pytest.raises(InputError, match="has schema version 99"):
        find_row(path, 0)


@pytest.mark.parametrize("name", [PARQUET, LINES])
def test_rows_that_are_not_there(name: str, tmp_path: Path, make_run: MakeRun) -> None:
    table = written(name, tmp_path, make_run(count=2))
    with pytest.raises(InputError, match="there is no such row"):
        find_row(table, 2)
    with pytest.raises(InputError, match="there is no such file"):
        find_row(tmp_path / f"no_{name}", 0)
    with pytest.raises(InputError, match="must end with"):
        check_table_target(tmp_path / "t.csv")


def test_runs_that_cannot_be_read_are_named_and_left_out(tmp_path: Path, make_run: MakeRun) -> None:
    good, bad = make_run("a", 3), make_run("b", 3)
    (bad / "run.json").write_text("{", "utf-8")
    table = tmp_path / "t.jsonl"
    collected = Collected([tmp_path / "runs"], table)
    write_table(collected, table)
    assert (collected.runs, collected.rows) == (1, 3)
    (words,) = collected.refused
    assert str(bad) in words
    assert {row.head.run for row in checked_rows(table) if isinstance(row, Row)} == {f"runs/{good.name}"}
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="holds no run"):
        list(Collected([tmp_path / "empty"], table))
