"""The notebook among the examples: well formed, kept without outputs, and run from top to bottom."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

NOTEBOOK = Path(__file__).resolve().parents[2] / "examples" / "first_grasp.ipynb"


def code_cells() -> list[str]:
    notebook = json.loads(NOTEBOOK.read_text("utf-8"))
    assert (notebook["nbformat"], notebook["metadata"]["kernelspec"]["language"]) == (4, "python")
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)
    return ["".join(cell["source"]) for cell in cells]


def test_it_is_kept_without_outputs_and_every_cell_is_python() -> None:
    cells = code_cells()
    assert len(cells) >= 5
    for cell in cells:
        compile(cell, NOTEBOOK.name, "exec")


@pytest.mark.slow
def test_it_runs_and_its_grasp_holds(tmp_path: Path) -> None:
    program = "\n".join([*code_cells(), "assert trial.held and grasp"])
    done = subprocess.run(
        [sys.executable, "-P", "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "first_grasp.json").is_file() and (tmp_path / "first_grasp.xml").is_file()
