"""Values, slopes, inputs and lines of cosines of (ratio x + offset), against a series in whole numbers."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest
from holdfast.solver.enclosure.trig import trig_inputs, trig_slope, trig_value
from holdfast.solver.enclosure.trig_line import beside_line
from holdfast.solver.interval import COSINE, SINE
from holdfast.solver.polynomial import TrigFunction

from ...exact import Exact

RATIOS = [1.05851325, 0.87, 0.8024, 1.13, 2.5, 1.0, 0.01, 37.0]


def cases(seed: int, count: int) -> Iterator[tuple[TrigFunction, float, float, np.random.Generator]]:
    """Functions, each with an interval of any width around some place."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        f = TrigFunction(0, int(rng.integers(2)), float(rng.choice(RATIOS)), float(rng.uniform(-3, 3)))
        a = float(rng.uniform(-3, 3))
        yield f, a, a + float(10.0 ** rng.uniform(-8, 0.5) / max(1.0, f.ratio / 2.5)), rng


def points(a: float, b: float, rng: np.random.Generator) -> list[Fraction]:
    return [Fraction(x) for x in (a, b, *rng.uniform(a, b, 12).tolist())]


def slope_at(f: TrigFunction, x: float) -> float:
    angle = f.ratio * x + f.offset
    return float(-f.ratio * np.sin(angle) if f.kind == COSINE else f.ratio * np.cos(angle))


def test_values_and_slopes_are_enclosed():
    for f, a, b, rng in cases(0, 200):
        lo, hi = trig_value(f.kind, f.ratio, f.offset, a, b)
        low, high = trig_slope(f.kind, f.ratio, f.offset, a, b)
        for x in points(a, b, rng):
            cosine, sine = Exact.cosine_and_sine(Fraction(f.ratio) * x + Fraction(f.offset))
            value, derived = (cosine, -sine) if f.kind == COSINE else (sine, cosine)
            assert Fraction(lo) <= value <= Fraction(hi)
            assert Fraction(low) <= Fraction(f.ratio) * derived <= Fraction(high)


def test_inputs_that_reach_a_value_are_kept_and_others_cut_off():
    narrowed = 0
    for f, a, b, rng in cases(1, 400):
        at = points(a, b, rng)
        values = [Exact.trig(f, x) for x in at]
        least, most = (
            float(values[3]) - 10.0 ** rng.uniform(-9, 0),
            float(values[3]) + 10.0 ** rng.uniform(-9, 0),
        )
        lo, hi = trig_inputs(f.kind, f.ratio, f.offset, least, most, a, b)
        assert a <= lo and hi <= b
        for x, value in zip(at, values, strict=True):
            if Fraction(least) <= value <= Fraction(most):
                assert Fraction(lo) <= x <= Fraction(hi), f
        # What is left is as narrow as can be: a little further in, the value is in range.
        narrowed += hi - lo < 0.9 * (b - a)
        for end, inwards in ((lo, 1e-6), (hi, -1e-6)):
            if a < end < b:
                near = float(Exact.trig(f, Fraction(end + inwards / f.ratio)))
                assert least - 2e-6 <= near <= most + 2e-6
    assert narrowed > 150


@pytest.mark.parametrize("kind", [COSINE, SINE])
def test_values_out_of_reach_leave_nothing(kind):
    assert trig_inputs(kind, 1.0585, 0.1, 1.5, 2.0, 0.0, 1.0) == (np.inf, -np.inf)
    assert trig_inputs(kind, 1.0585, 0.1, -3.0, -1.1, 0.0, 1.0) == (np.inf, -np.inf)
    lo, hi = trig_value(kind, 1.0585, 0.1, 0.3, 0.4)
    assert trig_inputs(kind, 1.0585, 0.1, hi + 1e-9, 1.0, 0.3, 0.4) == (np.inf, -np.inf)
    assert trig_inputs(kind, 1.0585, 0.1, -1.0, lo - 1e-9, 0.3, 0.4) == (np.inf, -np.inf)
    assert trig_inputs(kind, 1.0585, 0.1, -1.0, 1.0, 0.3, 0.4) == (0.3, 0.4)


def test_no_point_lies_beyond_the_lines_beside_a_function():
    for f, a, b, rng in cases(2, 400):
        slope = slope_at(f, rng.uniform(a, b)) if rng.uniform() < 0.7 else float(rng.normal() * 3.0)
        lo, hi = beside_line(f.kind, f.ratio, f.offset, slope, a, b)
        for x in points(a, b, rng):
            assert Fraction(lo) <= Exact.trig(f, x) - Fraction(slope) * x <= Fraction(hi), f


def test_lines_are_as_near_as_curvature_allows():
    """A chord is off by width^2 / 8 of the curvature; four slopes leave little more, over zeros too."""
    for f, a, b, _ in cases(3, 60):
        b = min(b, a + 0.6 / f.ratio)
        x = np.linspace(a, b, 401)
        values = (np.cos, np.sin)[f.kind](f.ratio * x + f.offset)
        chord = (values[-1] - values[0]) / (b - a)
        below, above = np.full(401, -np.inf), np.full(401, np.inf)
        for slope in (*(slope_at(f, at) for at in (a, b, 0.5 * (a + b))), chord):
            lo, hi = beside_line(f.kind, f.ratio, f.offset, slope, a, b)
            below, above = np.maximum(below, lo + slope * x), np.minimum(above, hi + slope * x)
        assert (above - below).max() < 0.13 * (f.ratio * (b - a)) ** 2 + 1e-13 * (1.0 + f.ratio)


def test_lines_over_more_than_all_are_bounded_by_the_range():
    lo, hi = beside_line(COSINE, 50.0, 0.0, 0.5, -100.0, 100.0)
    assert lo == pytest.approx(-51.0) and hi == pytest.approx(51.0)
    assert beside_line(SINE, 1.0, 0.0, 0.0, -np.inf, np.inf) == pytest.approx((-1.0, 1.0))
