"""`holdfast system`: exit codes, clean JSON, and one line for what is wrong."""

import json
import math
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from holdfast.base.text.console import Console
from holdfast.pipeline.cli.main import main

CIRCLE: dict[str, Any] = {
    "variables": {"x": [-2, 2], "y": [-2, 2]},
    "equations": ["x**2 + y**2 - 1", "x - y**3"],
}


def write(folder: Path, content: Any) -> str:
    path = folder / "system.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content), "utf-8")
    return str(path)


def result_of(capsys: pytest.CaptureFixture[str], code: int, *words: str) -> dict[str, Any]:
    """What `--json -` writes to stdout, and nothing else."""
    assert main(["system", *words, "--json", "-"]) == code
    out, err = capsys.readouterr()
    assert err == ""
    return json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


def test_solutions_are_isolated(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result = result_of(capsys, 0, write(tmp_path, CIRCLE))
    assert result["verdict"] == "complete"
    assert result["undecided"] == 0 and result["undecided_boxes"] == []
    assert result["boxes"] >= 1 and result["lps"] == 0 and result["seconds"] > 0.0
    y = 0.8260313576541870  # y^6 + y^2 = 1
    assert len(result["solutions"]) == 2
    for sign in (-1.0, 1.0):
        near = [s for s in result["solutions"] if abs(s["x"]["y"] - sign * y) <= s["radius"] + 1e-15]
        assert len(near) == 1
        assert near[0].keys() == {"x", "radius", "certified"} and near[0]["certified"] is True
        assert near[0]["x"].keys() == {"x", "y"}
        assert abs(near[0]["x"]["x"] - sign * y**3) < 1e-14 and 0.0 <= near[0]["radius"] < 1e-14


def test_what_has_no_solution_is_infeasible(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result = result_of(capsys, 3, write(tmp_path, {**CIRCLE, "equations": ["x**2 + y**2 + 1", "x - y"]}))
    assert result["verdict"] == "infeasible" and result["solutions"] == [] and result["undecided"] == 0


def test_a_double_root_is_undecided(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    double = {"variables": {"x": [-1, 1], "y": [-1, 1]}, "equations": ["x**2 - y", "y + y**3"]}
    result = result_of(capsys, 4, write(tmp_path, double))
    assert result["verdict"] == "undecided" and result["solutions"] == []
    assert result["undecided"] == len(result["undecided_boxes"]) >= 1
    assert any(box["x"][0] <= 0.0 <= box["x"][1] for box in result["undecided_boxes"])


def test_many_unknowns_stand_below_each_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = [f"x{k}" for k in range(12)]
    chain = [f"{b} - {a}" for a, b in pairwise(names)]
    system = {"variables": {name: [-2, 2] for name in names}, "equations": [*chain, "x0**2 - 2*x11 + 3/4"]}
    assert main(["system", str(write(tmp_path, system))]) == 0
    out = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in out[4:]] == [*names, "radius"]
    assert out[2].split() == ["unknown", "solution", "1", "solution", "2"]
    assert sorted(map(float, out[4].split()[1:])) == [0.5, 1.5]


def test_fewer_equations_than_unknowns_give_boxes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write(tmp_path, {**CIRCLE, "equations": ["x**2 + y**2 - 1"]})
    result = result_of(capsys, 0, file, "--sigma", "0.2")
    assert result["verdict"] == "complete" and result["solutions"] == [] and result["sigma"] == 0.2
    assert result["processed"] >= len(result["boxes"]) > 10
    for entry in result["boxes"]:
        assert isinstance(entry["certified"], bool)
        assert all(high - low <= 0.2 for low, high in entry["box"].values())
    for k in range(100):
        at = {"x": math.cos(k), "y": math.sin(k)}
        assert any(
            all(low - 1e-12 <= at[name] <= high + 1e-12 for name, (low, high) in entry["box"].items())
            for entry in result["boxes"]
        )


def test_a_spent_budget_is_undecided(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = "abcdef"
    equations = [f"{p}**3 - 2*{q}*{p} + 0.3" for p, q in zip(names, "bcdefa", strict=True)]
    file = write(tmp_path, {"variables": {name: [-5, 5] for name in names}, "equations": equations})
    result = result_of(capsys, 4, file, "--budget", "1e-9")
    assert result["verdict"] == "undecided" and result["undecided"] >= 1


NOON: dict[str, Any] = {
    "variables": {v: [-4, 4] for v in "abc"},
    "equations": [f"{p}*({q}**2 + {r}**2) - 1.1*{p} + 1" for p, q, r in ("abc", "bca", "cab")],
}


def without_time(result: dict[str, Any]) -> dict[str, Any]:
    assert result.pop("seconds") > 0.0
    return result


def test_a_search_that_was_left_is_resumed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, options = write(tmp_path, NOON), ("--order", "breadth", "--workers", "1")
    whole = result_of(capsys, 0, file, *options)
    assert whole["decided"] == 1.0 and whole["boxes"] > 3
    kept = ("--checkpoint", str(tmp_path / "noon.checkpoint"))
    left = result_of(capsys, 4, file, *options, *kept, "--budget", "1e-9")
    assert left["boxes"] == 1 and left["decided"] < 1.0 and left["undecided"] >= 1
    resumed = result_of(capsys, 0, file, *options, *kept, "--resume")
    assert without_time(resumed) == without_time(whole)


def test_a_checkpoint_is_one_systems_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "noon.checkpoint"
    words = [write(tmp_path, NOON), "--checkpoint", str(path)]
    assert main(["system", *words, "--quiet"]) == 0
    other = tmp_path / "other"
    other.mkdir()
    for says, again in (
        ("exists; resume it", words),
        ("another system, other settings", [*words, "--resume", "--order", "best"]),
        ("another system, other settings", [write(other, CIRCLE), *words[1:], "--resume"]),
    ):
        capsys.readouterr()
        assert main(["system", *again]) == 2
        out, err = capsys.readouterr()
        assert out == "" and err.startswith(f"holdfast: {path}: ") and says in err and err.count("\n") == 1
    path.write_bytes(path.read_bytes()[:-9])
    assert main(["system", *words, "--resume"]) == 2
    assert "is no checkpoint" in capsys.readouterr().err


def test_progress_says_how_far_the_search_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    monkeypatch.setattr(Console, "pass_by", lambda self, text: said.append(text))
    result = result_of(capsys, 0, write(tmp_path, NOON), "--workers", "1")
    assert len(said) > 3 and "% decided" in said[0]
    assert f"{len(result['solutions'])} found, {result['boxes']} boxes done, 0 open" in said[-1]
    assert "100.0% decided" in said[-1]


def test_text_and_json_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "out.json"
    assert main(["system", write(tmp_path, CIRCLE), "--json", str(target), "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("complete: 2 certified solutions, 0 undecided boxes;") and err == ""
    assert "0.826031358" in out
    assert json.loads(target.read_text("utf-8"))["verdict"] == "complete"


def test_long_tables_are_cut(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    equations = [f"({v} - 1)*({v} - 2)*({v} - 3)*({v} - 4)" for v in "xyz"]
    grid = {"variables": {v: [0, 9] for v in "xyz"}, "equations": equations}
    assert main(["system", write(tmp_path, grid), "--workers", "1"]) == 0
    out = capsys.readouterr().out
    assert "64 certified solutions" in out and "... and 14 more" in out


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ({**CIRCLE, "equations": ["x + yy", "y"]}, "equations.0: unknown variable 'yy'; did you mean 'y'?"),
        ({**CIRCLE, "equations": []}, "equations: "),
        ({"variables": CIRCLE["variables"]}, "equations: is required"),
        ({**CIRCLE, "variables": {"x": [2, -2], "y": [0, 1]}}, "variables.x: the lower end 2.0 is above"),
        ({"variables": {f"x{k}": [0, 1] for k in range(600)}, "equations": ["x1"]}, "variables: "),
        ({**CIRCLE, "equations": ["sin(x)"]}, "'sin' can't be called"),
        ({**CIRCLE, "equations": ["9**9**9*x"]}, "exponents are whole numbers from 0 to 60"),
        ({**CIRCLE, "equations": ["\x1b[31mx"]}, "equations.0: "),
        ({**CIRCLE, "equatoins": []}, "equatoins: unknown field; did you mean 'equations'?"),
        ('{"variables": {"x": [NaN, 1]}, "equations": ["x"]}', "NaN"),
        ('{"variables": {"x": [0, Infinity]}, "equations": ["x"]}', "Infinity"),
        ('{"variables": {"x": [0, 1e999]}, "equations": ["x"]}', "variables.x.1"),
        ('{"variables": {"x": [0, 1], "x": [0, 2]}, "equations": ["x"]}', "'x' stands twice"),
        ('{"variables": {"x": [0, 1]}', "not valid JSON"),
        ("x**2 - 1", "not valid JSON"),
        ("[1, 2]", "must be a JSON object"),
        ("[" * 100_000, "system.json"),
        ("", "is empty"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(
    content: Any, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write(tmp_path, content)
    assert main(["system", file, "--json", "-"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"holdfast: {file}") and err.endswith("\n") and err.count("\n") == 1
    assert says in err and err[:-1].isprintable()


def test_a_system_may_be_yaml(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "circle.yaml"
    file.write_text("variables: {x: [-2, 2], y: [-2, 2]}\nequations: [x**2 + y**2 - 1, x - y**3]\n")
    assert main(["system", str(file), "--json", "-"]) == 0
    from_yaml = json.loads(capsys.readouterr().out)["solutions"]
    assert main(["system", write(tmp_path, CIRCLE), "--json", "-"]) == 0
    assert from_yaml == json.loads(capsys.readouterr().out)["solutions"]

    file.write_text("variables: {x: [.nan, 1]}\nequations: [x]\n")
    assert main(["system", str(file)]) == 2
    assert "variables.x.0" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["missing.json"], "missing.json"),
        (["."], "."),
        ([], "FILE"),
        (["x.json", "--sigma", "0"], "above 0"),
        (["x.json", "--sigma", "nan"], "above 0"),
        (["x.json", "--budget", "-1"], "above 0"),
        (["x.json", "--first"], "--first"),
        (["x.json", "--order", "wide"], "depth"),
        (["x.json", "--workers", "0"], "1"),
        (["x.json", "--resume"], "--resume needs --checkpoint FILE"),
    ],
)
def test_bad_usage_is_one_line(words: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["system", *words]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("holdfast: ") and err.count("\n") == 1 and says in err


def test_not_utf8(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "system.json"
    path.write_bytes(b'{"variables": "\xff"}')
    assert main(["system", str(path)]) == 2
    assert "UTF-8" in capsys.readouterr().err


def test_an_interrupt_keeps_what_was_found(tmp_path: Path) -> None:
    """Ctrl-C after the first boxes: exit code 130, and JSON that is whole."""
    names = [f"x{k}" for k in range(8)]
    equations = [f"{p}**3 - 2*{q}*{p} + 0.3" for p, q in zip(names, [*names[1:], names[0]], strict=True)]
    file = write(tmp_path, {"variables": {name: [-50, 50] for name in names}, "equations": equations[:-1]})
    target = tmp_path / "out.json"
    # The signal is raised by the search itself after its 30th box, so that no clock is involved.
    script = (
        "import os, signal, sys\n"
        "from holdfast.base.text import console\n"
        "from holdfast.pipeline.cli import main\n"
        "calls = []\n"
        "def pass_by(self, text):\n"
        "    calls.append(text)\n"
        "    if len(calls) == 30:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "console.Console.pass_by = pass_by\n"
        "sys.exit(main(sys.argv[1:]))\n"
    )
    kept = ["--checkpoint", str(tmp_path / "search.checkpoint")]
    system = ["system", file, "--sigma", "1e-4", "--workers", "1", *kept]
    words = [sys.executable, "-P", "-c", script, *system, "--json", str(target)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 130, done.stderr
    assert "stopping" in done.stderr
    result = json.loads(target.read_text("utf-8"))
    assert result["verdict"] == "undecided" and result["undecided"] >= 1
    # What was kept is where the next run begins.
    assert main([*system, "--resume", "--budget", "1e-9", "--quiet", "--json", str(target)]) == 4
    assert json.loads(target.read_text("utf-8"))["processed"] > result["processed"] >= 30
