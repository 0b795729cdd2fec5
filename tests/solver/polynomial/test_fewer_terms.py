"""Equations combined so that they have fewer terms say what they said before, no more and no less."""

from fractions import Fraction

import pytest
from holdfast.solver import Verdict, solve_system
from holdfast.solver.polynomial import (
    ExactPolynomial,
    FactoredPolynomial,
    independent,
    parse_factors,
    with_fewer_terms,
)
from hypothesis import given, settings
from hypothesis import strategies as st

MONOMIALS = ((), ((0, 1),), ((1, 1),), ((0, 1), (1, 1)), ((2, 2),), ((2, 1),))

coefficients = st.lists(st.integers(-2, 2), min_size=len(MONOMIALS), max_size=len(MONOMIALS))


def equations(texts: list[str], names: str) -> list[FactoredPolynomial]:
    return [parse_factors(text, names.split(), "test", "text") for text in texts]


def almost_linear(n: int) -> list[FactoredPolynomial]:
    """Brown's almost linear system: n - 1 sums of all unknowns with one of them twice, and a product."""
    names = [f"x{k}" for k in range(n)]
    texts = [f"{name} + {' + '.join(names)} - {n + 1}" for name in names[1:]]
    return equations([*texts, "*".join(names) + " - 1"], " ".join(names))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(coefficients, min_size=2, max_size=5))
def test_what_comes_out_spans_the_same(rows):
    before = [
        ExactPolynomial({m: Fraction(c) for m, c in zip(MONOMIALS, row, strict=True) if c}) for row in rows
    ]
    given_ = [FactoredPolynomial.product([p]) for p in before]
    after = with_fewer_terms(given_)
    assert len(after) == len(given_)
    both = [factor for equation in (*given_, *after) for factor in equation]
    rank = len(independent([f for equation in given_ for f in equation]))
    assert len(independent(both)) == max(rank, len(independent([f for equation in after for f in equation])))
    for old, new in zip(given_, after, strict=True):
        assert sum(map(len, new)) <= sum(map(len, old))
        assert bool(new) <= bool(old), "a number other than zero stays one"
        assert new.is_zero == old.is_zero


def test_sums_that_are_shared_are_left_in_one_equation():
    out = with_fewer_terms(almost_linear(12))
    assert sorted(len(equation[0]) for equation in out) == [2] * 11 + [3]


def test_monomials_that_an_equation_lacks_are_not_brought_in():
    given_ = equations(["x**3 + x + y + z", "y**3 + x + y + z", "z**3 - 5*x"], "x y z")
    assert with_fewer_terms(given_) == given_


def test_products_and_repeated_equations_stay():
    given_ = equations(["(x - y)*(x + y - 3)", "x + y - 3", "2*x + 2*y - 6"], "x y")
    assert with_fewer_terms(given_) == given_


def test_sums_that_contradict_each_other_are_refuted_without_a_search():
    given_ = equations(["x + y*y - 1", "x + y*y - 1.000000000001"], "x y")
    result = solve_system(given_, [-1e8] * 2, [1e8] * 2)
    assert (result.verdict, result.boxes) == (Verdict.INFEASIBLE, 1)


@pytest.mark.parametrize(("n", "count"), [(29, 3), (30, 2)])
def test_a_large_almost_linear_system_is_solved_in_a_few_boxes(n, count):
    result = solve_system(almost_linear(n), [-1e8] * n, [1e8] * n, should_stop=lambda: False)
    assert (result.verdict, len(result)) == (Verdict.COMPLETE, count)
    assert result.boxes < 40
    ones = [box for box in result if all(box.lower <= 1.0) and all(box.upper >= 1.0)]
    assert len(ones) == 1
