"""The solver's functions refuse what they can't use, by name, before they search or write anything."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from holdfast.errors import InputError
from holdfast.objects import Task
from holdfast.solver import iterate, iterate_system, solve, solve_all, solve_system
from holdfast.solver.tasks import explain_infeasible

CIRCLE = {((0, 2),): 1, ((1, 2),): 1, (): -1}
NAN = math.nan

REFUSED = [
    *((name, "sigma", value, "a finite number above 0") for name in ("solve", "iterate", "solve_all",
      "solve_system", "iterate_system") for value in (NAN, 0.0, -1.0, math.inf, "0.1")),
    *((name, "workers", value, "a whole number of at least 1") for name in ("solve", "iterate", "solve_all",
      "solve_system", "iterate_system", "explain") for value in (0, -3, 1.5, NAN, None, True)),
    *((name, "budget_s", value, "a number of seconds of at least 0") for name in ("solve", "solve_all",
      "solve_system", "explain") for value in (NAN, -1.0, None)),
    *(("solve", "candidates", value, "a whole number of at least 1") for value in (0, -1, 1.0, NAN)),
    *((name, "seed", value, "a whole number of at least 0") for name in ("solve", "iterate", "explain")
      for value in (-1, 0.5, "1")),
    *((name, "order", value, "one of SearchOrder.DEPTH_FIRST") for name in ("solve", "iterate",
      "solve_system", "iterate_system") for value in ("depth", 1)),
]  # fmt: skip


@pytest.fixture(scope="module")
def functions(upholding: Task) -> dict[str, Callable[..., Any]]:
    return {
        "solve": lambda **options: solve(upholding, **options),
        "iterate": lambda **options: iterate(upholding, **options),
        "solve_all": lambda **options: solve_all(upholding, **options),
        "solve_system": lambda **options: solve_system([CIRCLE], [-2, -2], [2, 2], **options),
        "iterate_system": lambda **options: iterate_system([CIRCLE], [-2, -2], [2, 2], **options),
        "explain": lambda **options: explain_infeasible(upholding, **options),
    }


@pytest.mark.parametrize(("name", "argument", "value", "allowed"), REFUSED)
def test_arguments_out_of_range_are_refused_by_name(
    functions: dict[str, Callable[..., Any]], name: str, argument: str, value: object, allowed: str,
    tmp_path: Path,
) -> None:  # fmt: skip
    options = {} if name == "explain" else {"checkpoint": tmp_path / "search.checkpoint"}
    with pytest.raises(InputError, match=f"^{argument}: must be {allowed}") as caught:
        functions[name](**{argument: value}, **options)
    assert caught.value.source == argument
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("function", [solve, iterate, solve_all, explain_infeasible])
def test_the_name_of_a_task_is_no_task(function: Callable[..., Any]) -> None:
    with pytest.raises(InputError, match=r"^task: must be a Task, as `load_task` gives it, not 'upholding'"):
        function("upholding")


@pytest.mark.parametrize("function", [solve_system, iterate_system])
@pytest.mark.parametrize(
    ("equations", "lower", "upper", "message"),
    [
        ([CIRCLE, {((2, 1),): 1}], [-2, -2], [2, 2], r"equations\[1\]: has unknown 2, but the box has 2"),
        ([{((-1, 1),): 1}], [-2], [2], r"equations\[0\]: has unknown -1, but the box has 1"),
        (["x**2 - 1"], [-2], [2], r"equations\[0\]: must be a polynomial, as `parse_polynomial` gives it"),
        ([CIRCLE], [-2, -2], [2], "upper: must have as many ends as lower, 2, not 1"),
        ([CIRCLE], [-2, NAN], [2, 2], "lower, upper: unknown 1"),
        ([CIRCLE], [-2, 3], [2, 2], "lower, upper: unknown 1"),
    ],
)
def test_systems_that_make_no_sense_are_refused(
    function: Callable[..., Any], equations: list[Any], lower: list[float], upper: list[float], message: str
) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        function(equations, lower, upper)


def test_a_budget_may_be_without_limit(upholding: Task) -> None:
    assert len(solve(upholding, candidates=1, budget_s=math.inf)) == 1
