"""The metadata is what mlcroissant takes, and leads to the rows."""

import json
from collections.abc import Callable
from datetime import date
from pathlib import Path

import pytest
from holdfast.pipeline.database import Collected, Row, checked_rows, croissant, write_table


@pytest.mark.filterwarnings("ignore")  # of libraries behind it
def test_mlcroissant_reads_the_table_by_its_metadata(tmp_path: Path, make_run: Callable[..., Path]) -> None:
    pytest.importorskip("pyarrow")
    mlcroissant = pytest.importorskip("mlcroissant")
    table, about = tmp_path / "t.parquet", tmp_path / "t.croissant.json"
    write_table(Collected([make_run(count=9)], table), table)
    described = croissant(table, name="t", rows=9, published=date(2026, 11, 28), licence="CC-BY-4.0")
    about.write_text(json.dumps(described), "utf-8")
    dataset = mlcroissant.Dataset(about)
    assert not dataset.metadata.issues.errors and not dataset.metadata.issues.warnings
    rows = [row for row in checked_rows(table) if isinstance(row, Row)]
    for record, row in zip(dataset.records("grasps"), rows, strict=True):
        assert record["grasps/row"] == row.number
        assert record["grasps/grasp"].decode() == row.grasp.id
        assert list(record["grasps/object_position_m"]) == list(row.grasp.object.position)
