"""Exact work on polynomials: substitution, linear dependence, simplest fractions."""

from fractions import Fraction

import pytest
from holdfast.solver.polynomial.exact import evaluate, independent, normalised, simplest_between, substitute
from holdfast.solver.polynomial.parse import parse_polynomial
from hypothesis import given, settings
from hypothesis import strategies as st

fractions = st.fractions(-20, 20, max_denominator=1000)
often = settings(max_examples=200, deadline=None, derandomize=True)


def polynomial(text: str):
    return parse_polynomial(text, ["x", "y", "z"], "test", "text")


@often
@given(fractions, fractions, fractions)
def test_substituting_and_evaluating_agree(x, y, z):
    p = polynomial("x**3*y - 2.5*y**2*z + x*y*z/3 - 7*z + 1")
    for values in ({}, {0: x}, {1: y}, {0: x, 2: z}, {0: x, 1: y, 2: z}):
        rest = [v for k, v in enumerate((x, y, z)) if k not in values]
        assert evaluate(substitute(p, values), rest) == evaluate(p, [x, y, z])


@often
@given(fractions, fractions, fractions)
def test_values_of_sums_and_products_are_those_of_values(x, y, z):
    point = [x, y, z]
    p, q = polynomial("x**3*y - 2.5*y**2*z + 1"), polynomial("x**3*y + x*y*z/3 - 7*z")
    at_p, at_q = evaluate(p, point), evaluate(q, point)
    assert evaluate(p * q, point) == at_p * at_q
    assert (p * q).degree == p.degree + q.degree
    difference = polynomial("0")
    difference.add(p)
    difference.add(q, -1)
    assert evaluate(difference, point) == at_p - at_q
    assert ((0, 3), (1, 1)) not in difference, "what cancels is dropped"


def test_what_vanishes_is_dropped():
    assert substitute(polynomial("x*(y - 1)"), {0: Fraction(0)}) == {}
    assert substitute(polynomial("x - 0.5"), {0: Fraction(1, 2)}) == {}


@often
@given(fractions, fractions)
def test_simplest_between(a, b):
    low, high = min(a, b), max(a, b)
    found = simplest_between(low, high)
    assert low <= found <= high
    for q in range(1, min(found.denominator, 60)):
        assert low * q > (p := -((-low.numerator * q) // low.denominator)) or p > high * q


@pytest.mark.parametrize("value", [Fraction(1, 3), Fraction(-355, 113), Fraction(0), Fraction(22)])
def test_a_simple_fraction_is_found_again_from_floats(value):
    room = Fraction(1, 10**15)
    assert simplest_between(value - room, value + room) == value


def test_independent():
    p, q = polynomial("x*y - 1"), polynomial("x + y")
    both = {m: 2 * p.get(m, 0) - 3 * q.get(m, 0) for m in {**p, **q}}
    assert independent([p, q, both, {}]) == independent([p, q])
    assert len(independent([p, q, polynomial("x + y + z")])) == 3
    point = [Fraction(3), Fraction(1, 3), Fraction(5)]
    for reduced in independent([p, both, q]):
        assert (evaluate(reduced, point) == 0) == (evaluate(p, point) == 0 and evaluate(q, point) == 0) or (
            evaluate(reduced, point) == 0
        )


@pytest.mark.parametrize("text", ["1e300*x + 1", "1e-300*x*y", "3*x - 0.1", "(1e200*x)**3 - 1e290*y"])
def test_normalised_brings_coefficients_near_one(text):
    before, after = polynomial(text), normalised(polynomial(text))
    assert Fraction(1, 4) <= max(abs(c) for c in after.values()) <= 4
    ratios = {after[m] / before[m] for m in before}
    assert len(ratios) == 1
    ratio = ratios.pop()
    assert (ratio.numerator & (ratio.numerator - 1)) == (ratio.denominator & (ratio.denominator - 1)) == 0
