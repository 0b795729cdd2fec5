"""What can't be used is refused with the argument's name and what is allowed; all else is taken as it is."""

import math
from pathlib import Path

import numpy as np
import pytest
from holdfast.arguments import (
    check_budget,
    check_instance,
    check_number,
    check_path,
    check_whole_number,
)
from holdfast.errors import InputError


@pytest.mark.parametrize("value", [1, 0.5, np.float64(0.25), np.int32(3), 5e-324])
def test_numbers_are_taken(value: object) -> None:
    taken = check_number("sigma", value, above=0.0)
    assert type(taken) is float and taken == value


@pytest.mark.parametrize(
    "value", [0, -1.0, math.nan, math.inf, -math.inf, 10**400, "1", None, True, 1j, [1.0]]
)
def test_what_is_no_finite_number_above_zero_is_refused(value: object) -> None:
    with pytest.raises(InputError, match=r"^sigma: must be a finite number above 0, not ") as caught:
        check_number("sigma", value, above=0.0)
    assert caught.value.source == "sigma"


def test_a_least_value_is_allowed_itself() -> None:
    assert check_number("gap_m", 0.0, least=0.0) == 0.0
    with pytest.raises(InputError, match=r"of at least 0, not -0\.5"):
        check_number("gap_m", -0.5, least=0.0)
    assert check_number("offset", -3.0) == -3.0


@pytest.mark.parametrize("value", [0, 0.0, 60, math.inf, np.float32(1.5)])
def test_budgets_are_taken(value: object) -> None:
    assert check_budget("budget_s", value) == value


@pytest.mark.parametrize("value", [-1e-9, math.nan, -math.inf, "60", None, False])
def test_what_is_no_budget_is_refused(value: object) -> None:
    with pytest.raises(
        InputError, match=r"^budget_s: must be a number of seconds of at least 0, or inf, not "
    ):
        check_budget("budget_s", value)


@pytest.mark.parametrize("value", [1, 7, np.int64(2), 10**30])
def test_whole_numbers_are_taken(value: object) -> None:
    taken = check_whole_number("workers", value, least=1)
    assert type(taken) is int and taken == value


@pytest.mark.parametrize("value", [0, -3, 1.0, 2.5, math.nan, "2", None, True])
def test_what_is_no_whole_number_is_refused(value: object) -> None:
    with pytest.raises(InputError, match=r"^workers: must be a whole number of at least 1, not "):
        check_whole_number("workers", value, least=1)


def test_a_value_of_another_type_is_shown_in_a_few_words() -> None:
    assert check_instance("name", "abc", str, "a string") == "abc"
    with pytest.raises(InputError, match=r"^name: must be a string, not ") as caught:
        check_instance("name", ["x" * 1000] * 1000, str, "a string")
    assert len(str(caught.value)) < 300


def test_paths_are_taken_as_text_or_as_paths() -> None:
    assert check_path("out", "a b") == check_path("out", Path("a b")) == Path("a b")


@pytest.mark.parametrize("value", ["", None, 3, b"x.json", ["x"]])
def test_what_is_no_path_is_refused(value: object) -> None:
    with pytest.raises(InputError, match=r"^out: must be a path, as text or pathlib\.Path, not "):
        check_path("out", value)
