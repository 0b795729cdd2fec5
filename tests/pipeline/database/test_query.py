"""Questions in SQL, and that they reach nothing but the table."""

from collections.abc import Callable
from pathlib import Path

import pytest
from holdfast.errors import InputError
from holdfast.pipeline.database import Collected, Row, checked_rows, query_table, write_table

pytest.importorskip("duckdb")
pytest.importorskip("pyarrow")


@pytest.fixture
def table(tmp_path: Path, make_run: Callable[..., Path]) -> Path:
    path = tmp_path / "t.parquet"
    write_table(Collected([make_run(count=40)], path), path)
    return path


def test_answers_agree_with_the_rows(table: Path) -> None:
    rows = [row for row in checked_rows(table) if isinstance(row, Row)]
    good = [row for row in rows if row.grasp.is_good]
    assert 0 < len(good) < len(rows)
    sql = "SELECT row, joints['joint_1'], contacts[1].gap_m FROM grasps WHERE good ORDER BY row"
    answer = query_table(table, sql)
    expected = [(row.number, row.grasp.joints["joint_1"], row.grasp.contacts[0].gap) for row in good]
    assert answer.rows == expected and not answer.more
    assert query_table(table, "SELECT avg(residual_m) FROM grasps").rows[0][0] == pytest.approx(
        sum(row.grasp.residual for row in rows) / len(rows)
    )
    first = query_table(table, "FROM grasps SELECT row ORDER BY row", most=3)
    assert first.rows == [(0,), (1,), (2,)] and first.more
    assert query_table(table, "SELECT 'nan'::DOUBLE, DATE '2020-01-02', 1.5::DECIMAL(4,1)").rows == [
        (None, "2020-01-02", 1.5)
    ]


def test_a_damaged_table_is_told_by_its_file(table: Path) -> None:
    data = bytearray(table.read_bytes())
    data[8 : len(data) // 2] = bytes(len(data) // 2 - 8)
    table.write_bytes(data)
    with pytest.raises(InputError, match=r"t\.parquet: is damaged: \w"):
        query_table(table, "SELECT max(residual_m) FROM grasps")


@pytest.mark.parametrize(
    "sql",
    [
        "SELECT * FROM read_text('{folder}/secret')",
        "SELECT * FROM '{folder}/t.parquet'",
        "SELECT * FROM read_parquet('{folder}/t.parquet')",
        "SELECT * FROM glob('{folder}/*')",
        "COPY (SELECT 1 AS x) TO '{folder}/out.csv'",
        "COPY (SELECT 1 AS x) TO '{folder}/t.parquet' (USE_TMP_FILE false)",
        "ATTACH '{folder}/out.db'",
        "EXPORT DATABASE '{folder}/out'",
        "INSTALL httpfs",
        "SET enable_external_access = true",
        "SET memory_limit = '1TB'",
        "SELECT * FROM read_csv('http://127.0.0.1:9/x')",
        "SELECT 1; SELECT 2",
        "SELECT FROM",
        "",
        "SELECT * FROM path",  # a variable of the program is no table
    ],
)
def test_questions_reach_nothing_else(sql: str, table: Path) -> None:
    (table.parent / "secret").write_text("secret", "utf-8")
    before = {path: path.read_bytes() for path in table.parent.iterdir() if path.is_file()}
    with pytest.raises(InputError, match=r"^query: SQL: ") as caught:
        query_table(table, sql.format(folder=table.parent))
    assert "\n" not in str(caught.value) and "secret\n" not in str(caught.value)
    assert before == {path: path.read_bytes() for path in table.parent.iterdir() if path.is_file()}


def test_a_damaged_table_gives_no_answer(table: Path) -> None:
    data = bytearray(table.read_bytes())
    for place in range(4, len(data) // 2, 64):
        data[place] ^= 0x55
    table.write_bytes(data)
    with pytest.raises(InputError):
        query_table(table, "SELECT sum(residual_m), max(record) FROM grasps")
