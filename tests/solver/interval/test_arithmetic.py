"""Every operation encloses the exact result, as rational arithmetic tells."""

from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.interval import arithmetic as rounding
from hypothesis import example, given, settings
from hypothesis import strategies as st

often = settings(max_examples=400, deadline=None, derandomize=True)

SPECIAL = [0.0, -0.0, 5e-324, -5e-324, 2.2250738585072014e-308, 0.1, -0.1, 1 / 3, 1.0, -1.0, 1 + 2**-52, 1e16]


def reals(largest: float) -> st.SearchStrategy[float]:
    return st.one_of(
        st.sampled_from(SPECIAL), st.floats(-largest, largest, allow_nan=False), st.floats(-2, 2)
    )


def intervals(largest: float) -> st.SearchStrategy[tuple[float, float]]:
    return st.one_of(
        st.tuples(reals(largest), reals(largest)).map(lambda ends: (min(ends), max(ends))),
        reals(largest).map(lambda x: (x, x)),
    )


shares = st.sampled_from([Fraction(0), Fraction(1, 3), Fraction(1, 2), Fraction(5, 7), Fraction(1)])


def member(interval: tuple[float, float], share: Fraction) -> Fraction:
    low, high = Fraction(interval[0]), Fraction(interval[1])
    return low + share * (high - low)


def holds(result: tuple[float, float], value: Fraction) -> bool:
    """Infinite ends hold everything on their side; NaN ends hold nothing."""
    low, high = result
    return (low == -np.inf or (np.isfinite(low) and Fraction(low) <= value)) and (
        high == np.inf or (np.isfinite(high) and value <= Fraction(high))
    )


@often
@given(intervals(1e307), intervals(1e307), shares, shares)
@example((1.0, 1.0), (2.0**-60, 2.0**-60), Fraction(0), Fraction(0))
def test_sums_and_differences(a, b, s, t):
    x, y = member(a, s), member(b, t)
    assert holds(rounding.add(*a, *b), x + y)
    assert holds(rounding.sub(*a, *b), x - y)


@often
@given(intervals(1e150), intervals(1e150), shares, shares)
@example((5e-324, 5e-324), (0.5, 0.5), Fraction(0), Fraction(0))
def test_products(a, b, s, t):
    x, y = member(a, s), member(b, t)
    assert holds(rounding.mul(*a, *b), x * y)
    assert holds(rounding.scale(a[0], *b), Fraction(a[0]) * y)


# No quotient of these overflows.
divisors = intervals(1e150).filter(lambda b: all(end == 0.0 or abs(end) > 1e-150 for end in b))


@often
@given(intervals(1e150), divisors, shares, shares)
@example((1.0, 2.0), (0.0, 3.0), Fraction(0), Fraction(1))
@example((-2.0, -1.0), (0.0, 3.0), Fraction(0), Fraction(1))
@example((1.0, 2.0), (-3.0, 0.0), Fraction(0), Fraction(0))
@example((-2.0, -1.0), (-3.0, 0.0), Fraction(1), Fraction(0))
@example((1.0, 2.0), (-3.0, 3.0), Fraction(0), Fraction(0))
def test_quotients(a, b, s, t):
    x, y = member(a, s), member(b, t)
    if y != 0:
        assert holds(rounding.div(*a, *b), x / y)


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ((1.0, 2.0), (0.0, 4.0), (0.25, np.inf)),
        ((-2.0, -1.0), (0.0, 4.0), (-np.inf, -0.25)),
        ((1.0, 2.0), (-4.0, 0.0), (-np.inf, -0.25)),
        ((-2.0, -1.0), (-4.0, 0.0), (0.25, np.inf)),
        ((1.0, 2.0), (-1.0, 1.0), (-np.inf, np.inf)),
        ((-1.0, 2.0), (0.0, 1.0), (-np.inf, np.inf)),
        ((0.0, 0.0), (0.0, 0.0), (-np.inf, np.inf)),
    ],
)
def test_a_divisor_that_holds_zero_leaves_a_half_line_or_all(a, b, expected):
    assert rounding.div(*a, *b) == pytest.approx(expected, rel=1e-15)


@often
@given(intervals(1e150), shares)
def test_squares(a, s):
    result = rounding.sqr(*a)
    assert holds(result, member(a, s) ** 2)
    assert result[0] >= 0.0


@often
@given(intervals(1e30), st.integers(1, 9), shares)
def test_powers(a, n, s):
    result = rounding.power(*a, n)
    assert holds(result, member(a, s) ** n)
    assert n % 2 == 1 or result[0] >= -5e-324


@often
@given(intervals(1e300))
def test_square_roots(a):
    low, high = rounding.sqrt_interval(*a)
    assert 0 <= Fraction(low) ** 2 <= max(Fraction(a[0]), Fraction(0))
    assert high >= 0 and Fraction(high) ** 2 >= max(Fraction(a[1]), Fraction(0))


@often
@given(reals(1e300))
def test_one_step_outward_is_a_step_of_at_most_two_units(x):
    low, high = rounding.down(x), rounding.up(x)
    assert low < x < high
    assert low >= np.nextafter(np.nextafter(x, -np.inf), -np.inf)
    assert high <= np.nextafter(np.nextafter(x, np.inf), np.inf)


@often
@given(reals(1e100), reals(1e100))
def test_results_of_points_are_tight(x, y):
    for result in (rounding.add(x, x, y, y), rounding.sub(x, x, y, y), rounding.mul(x, x, y, y)):
        low, high = result
        assert high - low <= 4 * np.spacing(max(abs(low), abs(high)))


def test_an_end_at_infinity_does_not_spoil_the_other():
    assert rounding.sub(1.0, np.inf, 0.25, 0.5) == pytest.approx((0.5, np.inf))
    assert rounding.scale(0.0, -np.inf, np.inf) == (0.0, 0.0)


wide = st.one_of(
    st.sampled_from([-np.inf, -1.7e308, -1e200, -1.0, -5e-324, 0.0, 5e-324, 1.0, 1e200, 1.7e308, np.inf])
)
wide_intervals = (
    st.tuples(wide, wide)
    .map(lambda ends: (min(ends), max(ends)))
    .filter(lambda ends: ends[0] < np.inf and ends[1] > -np.inf)
)


def a_member(interval: tuple[float, float], share: Fraction) -> Fraction:
    """A number of an interval that may be infinite."""
    largest = float(np.finfo(float).max)
    return member((max(interval[0], -largest), min(interval[1], largest)), share)


@often
@given(wide_intervals, wide_intervals, shares, shares)
@example((-1.0, 0.0), (-np.inf, -5.0), Fraction(1), Fraction(1))
@example((5.0, np.inf), (0.0, 1.0), Fraction(1), Fraction(1))
@example((1e200, 1e200), (1e200, 1e200), Fraction(0), Fraction(0))
@example((-np.inf, np.inf), (1.0, np.inf), Fraction(0), Fraction(0))
def test_overflow_and_infinite_ends_lose_nothing(a, b, s, t):
    """No end is NaN: it would compare false with everything, and so cut at random."""
    x, y = a_member(a, s), a_member(b, t)
    assert holds(rounding.add(*a, *b), x + y)
    assert holds(rounding.sub(*a, *b), x - y)
    assert holds(rounding.mul(*a, *b), x * y)
    assert holds(rounding.sqr(*a), x * x)
    assert y == 0 or holds(rounding.div(*a, *b), x / y)
    for n in (1, 2, 3, 7, 60):
        assert holds(rounding.power(*a, n), x**n)
