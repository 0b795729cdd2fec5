from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.polynomial.polynomial import Polynomial, total
from holdfast.solver.polynomial.system import BernsteinFunction, SystemBuilder, bound_polynomial
from hypothesis import given, settings
from hypothesis import strategies as st

N = 4
quick = settings(max_examples=150, deadline=None, derandomize=True)
monomials = st.lists(st.integers(0, N - 1), max_size=5).map(lambda m: tuple(sorted(m)))
polynomials = st.dictionaries(monomials, st.integers(-64, 64).map(lambda k: k / 8), max_size=6).map(
    Polynomial
)
numbers = st.integers(-32, 32).map(lambda k: k / 8)
points = st.tuples(*[numbers] * N).map(np.array)


def by_powers(p: Polynomial, x: np.ndarray) -> float:
    """The value by exponents of each variable, another way than by factors."""
    exponents = np.array([[m.count(i) for i in range(N)] for m in p.terms]).reshape(-1, N)
    return float(np.array(list(p.terms.values())) @ np.prod(x**exponents, axis=1))


@quick
@given(polynomials, polynomials, numbers, points)
def test_algebra_agrees_with_the_algebra_of_values(p, q, c, x):
    a, b = by_powers(p, x), by_powers(q, x)
    for result, expected in (
        (p + q, a + b), (p - q, a - b), (p * q, a * b), (-p, -a), (p + c, a + c), (c + p, a + c),
        (p - c, a - c), (c - p, c - a), (p * c, a * c), (c * p, a * c), (total([p, q, p]), 2 * a + b),
    ):  # fmt: skip
        assert result.evaluate(x) == pytest.approx(expected, rel=1e-12, abs=1e-12)
        assert all(list(m) == sorted(m) for m in result.terms)
        assert 0.0 not in result.terms.values()


@quick
@given(polynomials, polynomials)
def test_degree_and_variables_follow_the_terms(p, q):
    assert (p - p).terms == {}
    assert (p - p).degree == 0
    assert (p * q).degree == (p.degree + q.degree if p.terms and q.terms else 0)
    assert p.variables == {i for m in p.terms for i in m}


@quick
@given(polynomials, st.lists(st.tuples(numbers, numbers), min_size=N, max_size=N), st.data())
def test_bounds_enclose_the_values(exact, p, ends, data):
    lower, upper = np.min(ends, axis=1), np.max(ends, axis=1)
    share = data.draw(st.sampled_from([Fraction(0), Fraction(1, 3), Fraction(6, 7), Fraction(1)]))
    x = [Fraction(lo) + share * (Fraction(hi) - Fraction(lo)) for lo, hi in zip(lower, upper, strict=True)]
    low, high = bound_polynomial(p, lower, upper)
    assert Fraction(low) <= exact.polynomial(p, x) <= Fraction(high)


def test_even_powers_are_bounded_below_by_zero():
    low, high = bound_polynomial(Polynomial({(0, 0, 0, 0): 1.0}), [-1.0], [2.0])
    assert (low, high) == pytest.approx((0.0, 16.0))


def test_a_builder_defines_each_form_once_and_keeps_multiples_of_a_variable():
    builder = SystemBuilder()
    x, y = builder.variable("x", 0, 1), builder.variable("y", 0, 1)
    assert builder.form("3x", x * 3.0).terms == (x * 3.0).terms
    first, again = builder.form("s", x + y), builder.form("t", x + y)
    assert first.terms == again.terms
    assert builder.product("xy", x + y, y).degree == 2
    system = builder.build()
    assert system.names == ("x", "y", "s")
    assert system.inputs.tolist() == [0, 1]
    assert system.definitions[2].terms == (x + y).terms
    assert (system.lower[2], system.upper[2]) == pytest.approx((0.0, 2.0))


def test_dimension_is_inputs_less_equations():
    builder = SystemBuilder()
    x, y, z = (builder.variable(name, -1, 1) for name in "xyz")
    builder.equate(x * x + y * y + z * z - 1.0)
    builder.imply(x - x * 1.0)
    w = builder.define("w", x * y)
    builder.at_least_zero(w)
    assert builder.build().dimension == 2


@pytest.mark.parametrize("shape", [(2, 2), (3, 2), (4, 4)])
def test_the_interval_of_a_bernstein_function_holds_its_values(exact, shape):
    rng = np.random.default_rng(0)
    builder = SystemBuilder()
    u, v = builder.variable("u", -1e-9, 1 + 1e-9), builder.variable("v", -1e-9, 1 + 1e-9)
    b = rng.normal(size=shape)
    builder.bernstein("f", u, v, b)
    system = builder.build()
    assert isinstance(system.definitions[2], BernsteinFunction)
    for s in (system.lower[0], 0.0, 0.3, 1.0, system.upper[0]):
        for t in (system.lower[1], 0.0, 0.7, 1.0, system.upper[1]):
            value = exact.bernstein(b, Fraction(s), Fraction(t))
            assert Fraction(system.lower[2]) <= value <= Fraction(system.upper[2])
