"""Bernstein functions in intervals hold the exact rational values and slopes."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from holdfast.solver.enclosure.bernstein import bernstein_value, control_points, workspace


def holds(enclosure: tuple[float, float], value: Fraction) -> bool:
    return Fraction(float(enclosure[0])) <= value <= Fraction(float(enclosure[1]))


def random_interval(rng: np.random.Generator) -> tuple[float, float]:
    low = float(rng.uniform(0.0, 1.0))
    return low, min(1.0, low + float(10.0 ** rng.uniform(-17, 0)))


def between(ends: tuple[float, float], share: Fraction) -> Fraction:
    low, high = map(Fraction, ends)
    return low + share * (high - low)


@pytest.mark.parametrize(("di", "dj"), [(0, 0), (1, 1), (2, 1), (3, 3), (1, 4)])
def test_values_and_slopes_hold_the_exact_ones(di, dj, exact):
    rng = np.random.default_rng(10 * di + dj)
    for _ in range(60):
        net = rng.normal(size=(di + 1, dj + 1))
        i, j = random_interval(rng), random_interval(rng)
        u, v = (between(ends, Fraction(int(rng.integers(0, 9)), 8)) for ends in (i, j))
        rows = [[Fraction(float(c)) for c in row] for row in net]

        def value_of(by_i, by_j, net=net, ends=(*i, *j)):
            return bernstein_value(net.ravel(), di, dj, *ends, by_i, by_j)

        assert holds(value_of(False, False), exact.bernstein(net, u, v))
        # The derivative is the function of the differences times the degree, which may be no floats.
        by_u = [[di * (b - a) for a, b in zip(*pair, strict=True)] for pair in pairwise(rows)]
        by_v = [[dj * (b - a) for a, b in pairwise(row)] for row in rows]
        assert holds(value_of(True, False), exact_value(by_u, u, v) if di else Fraction(0))
        assert holds(value_of(False, True), exact_value(by_v, u, v) if dj else Fraction(0))


def exact_value(rows: list[list[Fraction]], u: Fraction, v: Fraction) -> Fraction:
    """De Casteljau's rule on rationals, along v and then along u."""

    def along(points: list[Fraction], t: Fraction) -> Fraction:
        while len(points) > 1:
            points = [(1 - t) * a + t * b for a, b in pairwise(points)]
        return points[0]

    return along([along(row, v) for row in rows], u)


@pytest.mark.parametrize(("di", "dj"), [(1, 1), (2, 1), (3, 3), (1, 4)])
def test_the_control_points_of_a_part_are_a_net_of_it(di, dj, exact):
    """The part is the Bernstein function of the points, at the parameters inside of it."""
    rng = np.random.default_rng(10 * di + dj)
    for _ in range(30):
        net = rng.normal(size=(di + 1, dj + 1))
        i, j = random_interval(rng), random_interval(rng)
        work = workspace(np.array([[di, dj]]))
        lower, upper = control_points(net.ravel(), di, dj, *i, *j, work)
        assert np.all(lower <= upper) and np.abs(upper - lower).max() < 1e-13
        s, t = (Fraction(int(k), 8) for k in rng.integers(0, 9, 2))
        value = exact.bernstein(net, between(i, s), between(j, t))
        ends = [exact.bernstein(end.reshape(net.shape), s, t) for end in (lower, upper)]
        assert ends[0] <= value <= ends[1]
