"""The commands on tables, and the examples of docs/database.md."""

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from holdfast.base.files.json_file import read_json
from holdfast.base.files.output_file import write_json
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.database import COLUMNS, query_table
from holdfast.pipeline.records import RunRecord

DOCS = Path(__file__).resolve().parents[3] / "docs" / "database.md"
MakeRun = Callable[..., Path]


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", DOCS.read_text("utf-8"), re.S)


@pytest.fixture
def table(tmp_path: Path, make_run: MakeRun, monkeypatch: pytest.MonkeyPatch) -> Path:
    """`grasps.parquet` of made runs, in the current folder."""
    pytest.importorskip("pyarrow")
    monkeypatch.chdir(tmp_path)
    make_run("a", 30, seed=1)
    make_run("b", 30, seed=2)
    assert main(["table", "runs", "--out", "grasps.parquet", "--quiet"]) == 0
    return tmp_path / "grasps.parquet"


def test_the_documented_columns_are_those_of_the_code() -> None:
    part = DOCS.read_text("utf-8").partition("<!-- columns:")[2].partition("<!-- end of columns")[0]
    rows = re.findall(r"^\| `(\w+)` \| ([\w ]+) \| (.*) \|$", part, re.M)
    assert rows == [(column.name, column.kind, column.says) for column in COLUMNS]


@pytest.mark.parametrize("sql", blocks("sql"))
def test_the_documented_questions_have_answers(
    sql: str, table: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("duckdb")
    asked = sql.replace("index_flexion", "joint_1").replace(
        "AND proved_clear ", ""
    )  # what the made runs have
    assert query_table(table, asked).rows
    capsys.readouterr()
    assert main(["query", "grasps.parquet", asked, "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert len(said["rows"][0]) == len(said["columns"])
    assert main(["query", "grasps.parquet", asked, "--most", "2"]) == 0


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of the libraries
@pytest.mark.parametrize("program", blocks("python"))
def test_the_documented_programs_run(program: str, table: Path) -> None:
    pytest.importorskip("duckdb")
    if "pandas" in program:
        pytest.importorskip("pandas")
    exec(compile(program, str(DOCS), "exec"), {})


def test_a_question_without_an_answer(table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("duckdb")
    assert main(["query", "grasps.parquet", "FROM grasps WHERE row < 0"]) == 4
    assert main(["query", "grasps.parquet", "SELECT nothing FROM grasps"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_damaged_runs_and_rows_are_named(
    tmp_path: Path, make_run: MakeRun, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    make_run("a", 3)
    (make_run("b", 3) / "run.json").write_text("{}", "utf-8")
    assert main(["table", "runs", "--out", "t.jsonl"]) == 4
    assert "left out: runs/b/run.json" in capsys.readouterr().err
    assert main(["check", "t.jsonl"]) == 0
    assert "3 rows are whole, 0 damaged" in capsys.readouterr().out
    lines = Path("t.jsonl").read_text("utf-8").splitlines()
    Path("t.jsonl").write_text("\n".join([lines[0], lines[1].replace("index/tip", "index/top")]), "utf-8")
    assert main(["check", "t.jsonl", "--json", "-"]) == 4
    said = json.loads(capsys.readouterr().out)
    assert said["whole"] == 1 and "row 1: is damaged" in said["damaged"][0]


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["table", "runs", "--out", "t.csv"], "must end with"),
        (["table", "nowhere", "--out", "t.jsonl"], "there is no such folder"),
        (["table", "runs", "--out", "t.jsonl", "--croissant", "c.json"], "goes with a Parquet table"),
        (["table", "runs", "--out", "t.jsonl", "--licence", "x"], "goes with --croissant"),
        (["check", "no.jsonl"], "there is no such file"),
        (["check", "no.jsonl", "--task", "upholding"], "goes with --row"),
        (["query", "t.jsonl", "SELECT 1"], "is not a Parquet table"),
    ],
)
def test_misuse_is_answered_in_a_line(
    words: list[str],
    why: str,
    tmp_path: Path,
    make_run: MakeRun,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    make_run()
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and why in said
    assert not Path(words[-1]).is_file()


def test_a_row_is_tried_again_and_a_lie_is_found(
    run_path: Path, run_record: RunRecord, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A true row agrees in everything; of one that claims to be held better, the test says otherwise."""
    table, best = tmp_path / "t.jsonl", run_record.grasps[0]
    assert main(["table", str(run_path), "--out", str(table)]) == 0
    capsys.readouterr()
    assert main(["check", str(table), "--row", "0", "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["agrees"] and said["grasp"] == best.id
    looked_at = [entry["what"] for entry in said["findings"]]
    assert best.hold is not None
    assert looked_at[:6] == [
        "hand sa",
        "object scalpel",
        "task upholding",
        "certified",
        "clear",
        "clearance/mm",
    ]
    assert looked_at[-len(best.hold.directions) :][0] == "direction 1" and "held" in looked_at

    lying = tmp_path / "lying"
    shutil.copytree(run_path, lying)
    data = read_json(lying / "run.json")
    first = data["grasps"][0]
    first["hold"]["directions"][0]["slip"] *= 0.5
    first["hold"]["directions"][0]["outcome"] = "held"
    first["clearance"]["after"] += 0.001
    write_json(lying / "run.json", data)
    assert main(["table", str(lying), "--out", str(table)]) == 0
    capsys.readouterr()
    assert main(["check", str(table), "--row", "0"]) == 4
    assert "differs in clearance/mm, direction 1\n" in capsys.readouterr().out
    assert main(["check", str(table), "--row", "0", "--task", "handling"]) == 4
    assert "differs in task handling" in capsys.readouterr().out
