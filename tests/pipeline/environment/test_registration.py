"""Names are known once both packages are imported, in either order, and no command waits for Gymnasium."""

import subprocess
import sys

import pytest

from ..conftest import environment_for_subprocess

EXPECTED = "Holdfast/GraspChoice-v0 Holdfast/GraspChoiceSequential-v0"
MADE = f"print(*(gymnasium.spec(name).id for name in {EXPECTED.split()}))"


@pytest.mark.parametrize(
    "code",
    [
        "import holdfast, gymnasium",
        "import gymnasium, holdfast",
        "import gymnasium, holdfast, importlib; importlib.reload(holdfast)",
    ],
)
def test_names_are_known_after_import(code: str) -> None:
    found = subprocess.run(
        [sys.executable, "-W", "error", "-c", f"{code}\n{MADE}"],
        capture_output=True,
        text=True,
        check=True,
        env=environment_for_subprocess(),
    )
    assert found.stdout.strip() == EXPECTED


def test_importing_the_package_imports_neither_gymnasium_nor_numpy() -> None:
    code = "import holdfast, sys; print([m for m in ('gymnasium', 'numpy') if m in sys.modules])"
    found = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env=environment_for_subprocess(),
    )
    assert found.stdout.strip() == "[]"


def test_a_table_needs_neither_solver_nor_simulator() -> None:
    code = """import holdfast, gymnasium, sys
gymnasium.make("Holdfast/GraspChoice-v0").reset(seed=0)
print([m for m in ("mujoco", "numba", "fcl", "highspy", "scipy") if m in sys.modules])"""
    found = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env=environment_for_subprocess(),
    )
    assert found.stdout.strip() == "[]"
