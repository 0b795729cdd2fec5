"""The benchmark's reader of systems in the notation of ibex means what the notation means."""

import runpy
import sys
from pathlib import Path
from typing import Any

import pytest
from holdfast.solver import Verdict
from holdfast.solver.systems import solve_system
from holdfast.solver.systems.file import system_from_data

FOLDER = Path(__file__).parents[3] / "benchmarks" / "solving"
TEXT = """
// A circle and two lines, written in all ways that occur.
Constants
r in 5;  half = 1/2, n in 2;
Variables
x[n] in [-10^1, 2*10^1],
y in [ -1e1 , r + half ];   z in 3
Constraints
x(1)^2 + x[2]^2 = r^2;   /* two points on the axis of y */
x(1) = 0;
y - x(2)*half = 0;
z = 3;
end
"""


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(sys, "path", [str(FOLDER), str(FOLDER.parent), *sys.path])
    return runpy.run_path(str(FOLDER / "public_systems.py"))["read"]


def test_constants_powers_and_lists_are_read(read: Any, tmp_path: Path) -> None:
    path = tmp_path / "circle.bch"
    path.write_text(TEXT)
    found = read(path)
    of_x = {"x_1": (-10.0, 20.0), "x_2": (-10.0, 20.0)}
    assert found["variables"] == of_x | {"y": (-10.0, 5.5), "z": (3.0, 3.0)}
    assert len(found["equations"]) == 4


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("r in 5", "r in [4, 5]"),
        ("half = 1/2", "half = 1/0"),
        ("half = 1/2", "half = sqrt(2)"),
        ("10^1", "10^(10^9)"),
        ("y in [", "y [ "),
        ("x(1) = 0", "x(1) <= 0"),
        ("Variables", "function f(x)\nVariables"),
    ],
)
def test_what_means_something_else_is_left_out(read: Any, tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "circle.bch"
    path.write_text(TEXT.replace(old, new))
    with pytest.raises(ValueError):
        read(path)


def test_what_is_read_has_the_solutions_it_should(read: Any, tmp_path: Path) -> None:
    path = tmp_path / "circle.bch"
    path.write_text(TEXT.replace("z in 3", "z in [2, 4]"))
    problem = system_from_data(read(path), path.name)
    result = solve_system(problem.equations, problem.lower, problem.upper)
    assert result.verdict is Verdict.COMPLETE and len(result.solutions) == 2
