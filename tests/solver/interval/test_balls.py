"""Balls hold what exact arithmetic gives of any numbers within them."""

import math
from fractions import Fraction

import numpy as np
import pytest
from holdfast.check_proof.cosine import ERROR, ONE, cosine_and_sine, to_units
from holdfast.solver.interval import Balls


def drawn(rng: np.random.Generator, shape: tuple[int, ...], radius: float) -> tuple[Balls, np.ndarray]:
    """A ball and exact numbers (as fractions) within it, its ends among them."""
    scale = 10.0 ** rng.integers(-6, 6, shape)
    ball = Balls.within(rng.normal(size=shape) * scale, radius * scale)
    share = rng.choice([-1, 1, Fraction(1, 3), Fraction(-2, 7), 0], shape)
    mids, rads = (np.vectorize(Fraction, otypes=[object])(x) for x in (ball.mid, ball.rad))
    return ball, mids + rads * share


def holds(ball: Balls, exact: np.ndarray) -> bool:
    pairs = zip(ball.mid.ravel(), ball.rad.ravel(), np.asarray(exact, dtype=object).ravel(), strict=True)
    return all(abs(Fraction(mid) - x) <= Fraction(rad) for mid, rad, x in pairs)


@pytest.mark.parametrize("radius", [0.0, 1e-16, 1e-9, 0.3])
def test_arithmetic_holds_exact_results(radius: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(40):
        (a, x), (b, y) = (drawn(rng, (3, 4), radius) for _ in range(2))
        assert holds(a + b, x + y) and holds(a - b, x - y) and holds(a * b, x * y) and holds(-a, -x)
        assert holds(1.0 - a, 1 - x) and holds(a * 0.1, x * Fraction(0.1))
        assert holds(a.sum(axis=1), x.sum(axis=1)) and holds(a.sum(), np.array(x.sum()))
        c, z = drawn(rng, (4, 2), radius)
        assert holds(a @ c, x @ z)
        d = rng.normal(size=(4, 2))
        assert holds(a @ d, x @ np.vectorize(Fraction, otypes=[object])(d))
        nonzero = np.where(b.lower * b.upper > 0.0, 1.0, np.nan)
        quotient = a / b
        for i in np.ndindex(3, 4):
            if np.isnan(nonzero[i]):
                assert quotient.rad[i] == np.inf
            else:
                assert holds(quotient[i], np.array(x[i] / y[i]))


def test_a_root_holds_exact_ones_and_is_unknown_where_it_may_not_be() -> None:
    rng = np.random.default_rng(5)
    a, x = drawn(rng, (200,), 0.3)
    root = a.sqrt()
    for mid, rad, value in zip(root.mid, root.rad, x, strict=True):
        if np.isfinite(rad):
            low, high = Fraction(mid) - Fraction(rad), Fraction(mid) + Fraction(rad)
            assert value >= 0 and max(low, Fraction(0)) ** 2 <= value <= high**2
    assert np.isinf(root.rad[a.lower < 0.0]).all() and np.isfinite(root.rad).sum() > 50


def test_ends_and_sizes_are_outside() -> None:
    ball, x = drawn(np.random.default_rng(6), (100,), 1e-3)
    for low, high, most, value in zip(ball.lower, ball.upper, ball.most, x, strict=True):
        assert Fraction(low) <= value <= Fraction(high) and abs(value) <= Fraction(most)
    again = Balls.between(ball.lower, ball.upper)
    assert holds(again, x)


def test_cosine_and_sine_hold_values_to_many_digits() -> None:
    rng = np.random.default_rng(7)
    angles = Balls.within(rng.uniform(-7.0, 7.0, 100), rng.choice([0.0, 1e-12, 1e-2], 100))
    error = Fraction(ERROR, ONE)
    for which, ball in enumerate((angles.cosine(), angles.sine())):
        for k in range(100):
            for end in (-1, 0, 1):
                x = Fraction(angles.mid[k]) + end * Fraction(angles.rad[k])
                value = Fraction(cosine_and_sine(to_units(x))[which], ONE)
                assert abs(value - Fraction(ball.mid[k])) <= Fraction(ball.rad[k]) + error


def test_unit_vectors_and_vector_products() -> None:
    rng = np.random.default_rng(8)
    v, w = rng.normal(size=(2, 5, 3))
    unit = Balls.exact(v).unit()
    lengths = (unit * unit).sum(axis=1)
    assert np.all((lengths.lower <= 1.0) & (lengths.upper >= 1.0)) and lengths.rad.max() < 1e-14
    assert holds(
        Balls.exact(v).cross(w),
        np.array(
            [
                [
                    Fraction(a[j]) * Fraction(b[k]) - Fraction(a[k]) * Fraction(b[j])
                    for j, k in ((1, 2), (2, 0), (0, 1))
                ]
                for a, b in zip(v, w, strict=True)
            ],
            dtype=object,
        ),
    )


def test_what_is_unknown_stays_so() -> None:
    unknown = Balls.exact(1.0) / Balls.within(0.0, 1.0)
    for ball in (unknown, unknown * 0.0, unknown - unknown, unknown.sqrt(), unknown.sum(), 1.0 / unknown):
        assert math.isinf(float(ball.rad))
