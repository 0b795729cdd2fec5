"""`holdfast best`: the least friction and the largest load, their exit codes, proofs and plain data."""

import json
from pathlib import Path
from typing import Any

import pytest
from holdfast.pipeline.cli.main import main


def result_of(capsys: pytest.CaptureFixture[str], code: int, *words: str) -> dict[str, Any]:
    """What `--json -` writes to stdout, and nothing else."""
    assert main(["best", *words, "--quiet", "--json", "-"]) == code
    return json.loads(capsys.readouterr().out, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))


def test_the_load_with_a_proof(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    proof = str(tmp_path / "load.proof")
    found = result_of(capsys, 0, "upholding", "--for", "load", "--max-force", "20", "--proof", proof)
    assert found["for"] == "load" and found["max_force"] == 20.0 and found["gap"] <= 0.02
    assert 0.0 < found["multiple"] <= found["at_most"] < found["in_test_at_most"]
    assert found["history"][-1]["at_most"] == found["at_most"]
    assert main(["check-proof", proof, "--task", "upholding"]) == 0
    assert f"at most {found['at_most']:.6g} times the weight with 20 N a contact" in capsys.readouterr().out
    assert main(["check-proof", proof, "--task", "handling"]) == 4
    assert "not those of the task" in capsys.readouterr().out


def test_friction_has_no_forces(capsys: pytest.CaptureFixture[str]) -> None:
    found = result_of(capsys, 0, "upholding", "--for", "friction")
    assert 0.37 < found["refuted"] <= found["friction"] < 0.39 and "max_force" not in found
    assert main(["best", "upholding", "--for", "friction", "--max-force", "3"]) == 2
    assert "--max-force goes with --for load" in capsys.readouterr().err


def test_what_is_not_near_enough_yet(capsys: pytest.CaptureFixture[str]) -> None:
    found = result_of(capsys, 4, "handling", "--for", "load", "--gap", "1e-9", "--budget", "0.2")
    assert found["at_most"] is None or found["at_most"] >= found["multiple"]


def test_of_a_cone_of_gravity_nothing_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["best", "service", "--for", "load"]) == 2
    assert "acts along few directions" in capsys.readouterr().err
