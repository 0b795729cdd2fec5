"""Real roots of one unknown, against roots that are known and against numpy."""

from fractions import Fraction
from functools import reduce

import numpy as np
import pytest
from holdfast.solver.polynomial.real_roots import RealRoot, real_roots
from holdfast.solver.polynomial.whole import (
    WholePolynomial,
    common_divisor,
    derivative,
    quotient,
    sign_at,
    to_exact,
    whole_polynomial,
    without_multiple_roots,
)

WIDE = Fraction(-(10**6)), Fraction(10**6)


def product(*factors: WholePolynomial) -> WholePolynomial:
    return reduce(lambda p, q: tuple(np.convolve(np.array(p, object), np.array(q, object)).tolist()), factors)


def from_roots(roots: list[Fraction]) -> WholePolynomial:
    return product(*((-r.numerator, r.denominator) for r in roots))


def holds_one(root: RealRoot) -> bool:
    """Whether the polynomial of a root changes its sign there, or is zero at a rational one."""
    if root.is_rational:
        return sign_at(root.polynomial, root.lower) == 0
    return sign_at(root.polynomial, root.lower) * sign_at(root.polynomial, root.upper) == -1


def random_roots(rng: np.random.Generator, count: int) -> list[Fraction]:
    return sorted({Fraction(int(rng.integers(-60, 61)), int(rng.integers(1, 9))) for _ in range(count)})


@pytest.mark.parametrize("seed", range(30))
def test_rational_roots_are_found_exactly_however_often_they_count(seed):
    rng = np.random.default_rng(seed)
    roots = random_roots(rng, int(rng.integers(1, 12)))
    multiple = product(*(from_roots([r]) for r in roots for _ in range(int(rng.integers(1, 4)))), (3, 0, 1))
    lower, upper = sorted([roots[0], Fraction(int(rng.integers(-70, 71)), 3)])
    found = real_roots(without_multiple_roots(multiple), lower, upper)
    assert [root.lower for root in found] == [r for r in roots if lower <= r <= upper]
    assert all(root.is_rational and holds_one(root) for root in found)


@pytest.mark.parametrize("seed", range(20))
def test_as_many_roots_as_numpy_finds(seed):
    rng = np.random.default_rng(seed)
    p = without_multiple_roots(
        whole_polynomial({((0, k),) if k else (): Fraction(int(rng.integers(-99, 100))) for k in range(9)})
    )
    roots = np.roots([float(c) for c in reversed(p)])
    real = np.sort(roots.real[np.abs(roots.imag) < 1e-9])
    found = real_roots(p, *WIDE)
    np.testing.assert_allclose([float(root.lower) for root in found], real, rtol=1e-9, atol=1e-9)
    assert all(holds_one(root) for root in found)
    assert all(float(root.upper - root.lower) <= 3e-16 * abs(float(root.upper)) for root in found)


def test_roots_that_lie_next_to_each_other_are_told_apart():
    mignotte = (-2, 4000, -2000000, *[0] * 17, 1)  # x^20 - 2 (1000 x - 1)^2
    left, low, high, right = real_roots(mignotte, *WIDE)
    assert low.upper <= high.lower and high.upper - low.lower < Fraction(1, 10**29)
    assert abs(low.lower - Fraction(1, 1000)) < Fraction(1, 10**29)
    assert -3 < left.lower < right.upper < 3
    assert all(map(holds_one, (left, low, high, right)))


def test_chebyshev_polynomials_have_the_roots_of_cosines():
    p, q = (1,), (0, 1)
    for _ in range(49):
        twice = product((0, 2), q)
        p, q = q, tuple(a - b for a, b in zip(twice, [*p, 0, 0], strict=True))
    found = real_roots(without_multiple_roots(whole_polynomial(to_exact(q, 0))), Fraction(-1), Fraction(1))
    np.testing.assert_allclose(
        [float(root.lower) for root in found], np.cos((np.arange(49, -1, -1) + 0.5) * np.pi / 50), atol=1e-15
    )


def test_none_where_there_is_none():
    assert real_roots((1, 0, 1), *WIDE) == []
    assert real_roots((7,), *WIDE) == []
    assert real_roots((-2, 0, 1), Fraction(-1), Fraction(1)) == []


@pytest.mark.parametrize("seed", range(20))
def test_common_divisors_divide_both_and_hold_all_that_is_shared(seed):
    rng = np.random.default_rng(seed)
    shared, one, other = (random_roots(rng, 3) for _ in range(3))
    p, q = from_roots(shared + one), from_roots(shared + other)
    expected = from_roots(sorted(set(shared) | set(one) & set(other)))
    got = without_multiple_roots(common_divisor(p, q))
    assert got == whole_polynomial(to_exact(expected, 0))
    assert product(quotient(p, common_divisor(p, q)), common_divisor(p, q)) in (p, tuple(-c for c in p))
    assert derivative((5,)) == () and common_divisor((2, 4), ()) == (1, 2)
