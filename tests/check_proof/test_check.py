"""Proof logs that the solver writes are accepted, for the system that was asked for and no other."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from holdfast.check_proof import check_proof
from holdfast.solver import Verdict, solve, task_form

from .logs import INFEASIBLE, plates, read, search


def test_a_proof_is_accepted_for_its_task_and_for_no_other(proved):
    task, path = proved
    check = check_proof(path, task_form(task))
    assert check.accepted and check.reason == ""
    assert check.boxes > 3 and check.steps > check.boxes
    assert check_proof(path).accepted
    other = check_proof(path, task_form(plates(0.1100001)))
    assert not other.accepted and "not that of the task" in other.reason


def test_proofs_are_small_and_say_the_same_each_time(tmp_path):
    files = [tmp_path / "a.proof", tmp_path / "b.proof"]
    for path in files:
        assert solve(plates(0.13), candidates=1, proof=path).verdict is Verdict.INFEASIBLE
        assert check_proof(path).accepted
    assert files[0].read_bytes() == files[1].read_bytes()
    assert files[0].stat().st_size < 100_000


def test_curved_faces_and_pure_search_are_proved_as_well(tmp_path):
    task, path = plates(0.13, 2), tmp_path / "curved.proof"
    assert solve(task, pure=True, budget_s=300, proof=path).verdict is Verdict.INFEASIBLE
    assert any(f for f in read(path)[1]["form"]["functions"])
    assert check_proof(path, task_form(task)).accepted


@pytest.mark.parametrize("name", INFEASIBLE)
@pytest.mark.parametrize("tightened", [0, 2])
def test_small_systems(name, tightened, tmp_path):
    path = tmp_path / "toy.proof"
    assert search(INFEASIBLE[name], path, tightened)
    check = check_proof(path)
    assert check.accepted, check.reason
    assert check.boxes > 1
    assert (check.steps > 0) == (tightened > 0)


def test_the_checker_imports_nothing_of_what_it_checks():
    room = Path(sys.modules["holdfast.check_proof"].__file__).parent
    beyond = set()
    for source in room.rglob("*.py"):
        package = ["holdfast", "check_proof", *source.relative_to(room).parts[:-1]]
        for node in ast.walk(ast.parse(source.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                beyond |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                above = package[: len(package) - node.level + 1] if node.level else []
                beyond.add(".".join([*above, *([node.module] if node.module else [])]))
    own = {name for name in beyond if name.startswith("holdfast.check_proof")}
    beyond = {name for name in beyond - own if name.split(".")[0] not in sys.stdlib_module_names}
    # `arrays` names types of arrays, and knows nothing of what they are for.
    assert beyond == {
        "numpy",
        "holdfast.base.numeric.arrays",
        "holdfast.errors",
        "holdfast.base.files.input_file",
    }


def test_the_checker_brings_nothing_of_ours_along():
    """Neither the solver nor compiled code is loaded with it, in a process of its own."""
    program = "import sys; from holdfast.check_proof import check_proof; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    modules = set(loaded.stdout.split())
    assert "holdfast.check_proof.replay" in modules
    rooms = ("holdfast.solver", "holdfast.objects", "holdfast.base.machine.jit")
    assert not [name for name in modules if name.startswith(rooms)]
    assert not modules & {"numba", "highspy", "scipy"}
