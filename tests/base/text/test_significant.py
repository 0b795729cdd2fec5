"""Numbers for people."""

import pytest
from holdfast.base.text.significant import significant


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (99.7, 2, "100"),
        (123456.0, 3, "123000"),
        (0.00123456, 3, "0.00123"),
        (-0.0, 2, "0"),
        (-1e-300, 2, "-1e-300"),
        (9.81, 2, "9.8"),
        (0.1, 3, "0.1"),
        (1e20, 2, "1e+20"),
        (float("inf"), 2, "inf"),
    ],
)
def test_numbers_are_rounded_and_written_without_exponents_where_these_are_no_shorter(value, digits, text):
    assert significant(value, digits) == text
